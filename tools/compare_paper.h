/* SPDX-License-Identifier: MIT */
/**
 * @file compare_paper.h
 * The experiments of T. Tung and T. Matsuyama, "Invariant Shape Descriptor for 3D Video Encoding",
 * Sect. 5, on any capture: how much geometry images change from frame to frame (Table 1), how near
 * the decoded surfaces are (Table 2), and how many bytes they take (Table 3).
 *
 * Three sequences of geometry images are compared: `gis`, every frame cut by itself
 * (encode/reference.h); `fixed`, this method; `mixed`, this method on the same motion captured at
 * varying resolution.
 */
#ifndef GVC_TOOLS_COMPARE_PAPER_H
#define GVC_TOOLS_COMPARE_PAPER_H

#include "compare.h"

#define PAPER_COMPONENTS 3
#define PAPER_TABLES 3
#define PAPER_REFERENCE_VERTICES 125
#define PAPER_KB 1000.0

typedef enum paper_method { PAPER_GIS, PAPER_FIXED, PAPER_MIXED, PAPER_METHODS } paper_method;

/** "gis", "fixed", "mixed". */
const char *paper_method_name(paper_method method);

typedef struct paper_options {
    uint32_t size; /**< samples a side; the paper: 128 */
    double crf;    /**< x264's rate factor, the same for all methods */
    uint32_t gop;  /**< frames per group of pictures, the same for all methods */
    unsigned threads;
    size_t samples;           /**< per direction of a distance; 0: as gvc_mesh_distance */
    bool table[PAPER_TABLES]; /**< which are asked for; without 2 and 3 nothing is coded */
    /** Told now and then; false stops the measurement. `what` is a few words, such as "gis". */
    bool (*progress)(void *user, const char *what, uint64_t done, uint64_t total);
    void *user;
} paper_options;

/** Whether Table 2 or 3 is asked for. */
static inline bool paper_codes(const paper_options *options) {
    return options->table[1] || options->table[2];
}

/* ------------------------------------------------------------------------------------- Table 1 */

/** The cube whose side is the range 0..255 of 8-bit images: centred on the bounding box of all
 * frames of a capture, its side the longest of the box. */
typedef struct paper_cube {
    double origin[3], side;
} paper_cube;

/** Geometry images of a sequence at 8 bits a component. */
typedef struct paper_images {
    uint64_t frame_count;
    uint32_t size;
    paper_cube cube;
    uint8_t *code; /**< per frame 3 planes of size * size */
} paper_images;

gvc_result paper_images_create(uint64_t frame_count, uint32_t size, const paper_cube *cube,
                               paper_images *images, gvc_error *error);
void paper_images_free(paper_images *images);
/** Rounds coordinates (3 planes, x first) to the nearest of 256 steps; beyond the cube to its side.
 * Thread-safe for different frames. */
void paper_images_set(paper_images *images, uint64_t frame, const double *coordinates);
/** Mean over the samples of the squared difference of frames `frame` and `frame` + 1, summed over
 * the three components. */
double paper_images_mse(const paper_images *images, uint64_t frame);

/* ------------------------------------------------------------------------------------- results */

/** A capture as geometry images made one way. NaN: not measured. */
typedef struct paper_result {
    bool measured;
    uint64_t frame_count;
    double *mse;      /**< frame_count - 1 values, summed over the components */
    double mse_mean;  /**< of those; NaN for a single frame */
    double hausdorff; /**< of the decoded frames, mean, fraction of the diagonal */
    double rms;       /**< of the decoded frames, root mean square, fraction of the diagonal */
    double bytes;
    uint64_t segment_count; /**< layouts of the sequence */
} paper_result;

void paper_result_free(paper_result *result);
/** Fills mse and mse_mean. */
gvc_result paper_result_set_mse(paper_result *result, const paper_images *images, gvc_error *error);

/** Cube of a capture. GVC_ERROR_MESH, naming file and frame, if a frame cannot be coded. */
gvc_result paper_find_cube(const gvc_source *source, const paper_options *options, paper_cube *cube,
                           gvc_error *error);

/** This method, through the encoder. `what` names it to options->progress. */
gvc_result paper_measure_ours(const gvc_source *source, const paper_cube *cube, const char *what,
                              const paper_options *options, paper_result *made, gvc_error *error);

/** Frames cut by themselves (encode/reference.h). */
gvc_result paper_measure_gis(const gvc_source *source, const paper_cube *cube,
                             const paper_options *options, paper_result *made, gvc_error *error);

/* ------------------------------------------------------------------------------------ captures */

/** What the paper says of one of its captures. */
typedef struct paper_row {
    const char *name;
    unsigned frame_count;
    double mse[PAPER_METHODS];            /**< Table 1 */
    double hausdorff_gis, hausdorff_ours; /**< Table 2 */
    double hausdorff_reference;
    double kb_zip, kb_gis, kb_ours; /**< Table 3 */
} paper_row;

/** The row of this name; case does not matter. NULL if the paper has none. */
const paper_row *paper_row_named(const char *name);
/** The row a capture's name begins with, as "Samba" of "samba_v1000"; NULL if there is none. */
const paper_row *paper_row_of_capture(const char *name);

/** What to measure. */
typedef struct paper_request {
    const gvc_source *source;
    const gvc_source *mixed; /**< may be NULL */
    /** As of compare_zip. */
    gvc_result (*original_off)(void *user, uint64_t frame, gvc_buffer *bytes, gvc_error *error);
    bool method[PAPER_METHODS];
    bool reference, zip;
} paper_request;

typedef struct paper_capture {
    char name[64];
    const paper_row *row; /**< NULL: not one of the paper's */
    uint64_t frame_count;
    paper_cube cube;
    paper_result result[PAPER_METHODS];
    double hausdorff_reference; /**< NaN: not measured */
    double zip_bytes;           /**< NaN: not measured */
} paper_capture;

/** Measures everything asked for; name and row are left to the caller. Free with
 * paper_capture_free, on failure too. */
gvc_result paper_measure(const paper_request *request, const paper_options *options,
                         paper_capture *capture, gvc_error *error);
void paper_capture_free(paper_capture *capture);

/* ------------------------------------------------------------------------------------ printers */

/* They append to `text`; out of memory shows in `text->failed`. */

void paper_print_tables(const paper_capture *captures, size_t count, const paper_options *options,
                        gvc_buffer *text);
/** One object with the settings and "captures": for each its cube, for each method what
 * paper_result holds, null where not measured, and what the paper says of it. */
void paper_print_json(const paper_capture *captures, size_t count, const paper_options *options,
                      gvc_buffer *text);
/** One line per capture and method measured, with a header line; the paper's figures on lines of
 * their own, whose method is "paper gis" and so on. */
void paper_print_csv(const paper_capture *captures, size_t count, gvc_buffer *text);
/** SVG: the change of the images over time, one diagram a capture (the paper's Fig. 9). */
void paper_print_plot(const paper_capture *captures, size_t count, gvc_buffer *text);

#endif
