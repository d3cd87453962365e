/* SPDX-License-Identifier: MIT */
/**
 * @file gvc.h
 * Public interface of libgvc, the reference implementation of the `.gvc` file: 3D video (a triangle
 * mesh per frame) coded as one H.264 video of geometry images, or without loss.
 *
 * Conventions
 *  - Every function that can fail returns a `gvc_result` and takes a `gvc_error *` as its last
 *    argument, which may be NULL. On failure it holds the code, a sentence for a person, and where
 * it happened; on success it is untouched.
 *  - On failure no object is handed out: output pointers are set to NULL.
 *  - There is no global state. An opened `gvc_reader` is immutable and may be shared by threads; a
 *    `gvc_decoder` belongs to one thread at a time; meshes are plain data.
 *  - Option structs begin with their own size; always start from their `_init` function.
 */
#ifndef GVC_GVC_H
#define GVC_GVC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(GVC_STATIC)
#define GVC_API
#else
#define GVC_API __attribute__((visibility("default"))) /**< exported from the shared library */
#endif
#define GVC_NODISCARD __attribute__((warn_unused_result)) /**< the result must be looked at */

/** Version of the library (not of the file format, which gvc_info.format_version tells). */
#define GVC_VERSION_MAJOR 0
#define GVC_VERSION_MINOR 1 /**< see GVC_VERSION_MAJOR */
#define GVC_VERSION_PATCH 0 /**< see GVC_VERSION_MAJOR */

/** "major.minor.patch" of the library in use. */
GVC_API const char *gvc_version(void);

/* ------------------------------------------------------------------------------------- results */

/** Result codes. Numbers never change meaning; gaps are left for later ones. */
typedef enum gvc_result {
    GVC_OK = 0,
    GVC_ERROR_ARGUMENT = 1,   /**< the caller broke this interface's contract */
    GVC_ERROR_MEMORY = 2,     /**< an allocation failed */
    GVC_ERROR_IO = 3,         /**< reading or writing failed (missing file, full disk, ...) */
    GVC_ERROR_CANCELLED = 4,  /**< a callback asked to stop */
    GVC_ERROR_CORRUPT = 10,   /**< the bytes break the format */
    GVC_ERROR_TRUNCATED = 11, /**< the bytes end before they should */
    GVC_ERROR_UNSUPPORTED =
        12,               /**< well-formed, but a feature or version this build does not know */
    GVC_ERROR_LIMIT = 13, /**< well-formed, but beyond a limit the caller set */
    GVC_ERROR_LOST = 14,  /**< the file says so: lost before it was repaired */
    GVC_ERROR_MESH = 20,  /**< an input mesh that cannot be coded (open, non-manifold, NaN, ...) */
    GVC_ERROR_QUALITY = 21, /**< the geometric error asked for cannot be reached */
    GVC_ERROR_INTERNAL = 99 /**< a bug in this library */
} gvc_result;

/** Short English name of a result, never NULL. */
GVC_API const char *gvc_result_string(gvc_result result);

#define GVC_NO_FRAME (-1)        /**< gvc_error.frame: not about one frame */
#define GVC_NO_OFFSET UINT64_MAX /**< gvc_error.offset: not about one place in a file */

/** What went wrong and where. Plain data; may be copied. Always initialise with gvc_error_init. */
typedef struct gvc_error {
    gvc_result code; /**< kind of the failure */
    int64_t frame;   /**< zero-based frame, or GVC_NO_FRAME */
    uint64_t offset; /**< byte offset in the file being read, or GVC_NO_OFFSET */
    char where[96]; /**< box path in a .gvc file ("moof/traf/trun"), or a file name; may be empty */
    char message[320]; /**< one sentence without a final full stop */
} gvc_error;

/** GVC_OK, no frame, no offset, empty texts. */
GVC_API void gvc_error_init(gvc_error *error);

/* -------------------------------------------------------------------------------------- meshes */

/** A triangle mesh: V positions and F index triples. Owned by whoever received it. */
typedef struct gvc_mesh gvc_mesh;

/** Copies `3 * vertex_count` coordinates and `3 * face_count` indices into a new mesh.
 *  GVC_ERROR_MESH for an index out of range or a coordinate that is not finite. */
GVC_API GVC_NODISCARD gvc_result gvc_mesh_create(const double *positions, size_t vertex_count,
                                                 const uint32_t *faces, size_t face_count,
                                                 gvc_mesh **mesh, gvc_error *error);
/** Frees the mesh and nulls the caller's pointer. NULL and pointer to NULL are fine. */
GVC_API void gvc_mesh_destroy(gvc_mesh **mesh);
/** V. */
GVC_API size_t gvc_mesh_vertex_count(const gvc_mesh *mesh);
/** F. */
GVC_API size_t gvc_mesh_face_count(const gvc_mesh *mesh);
/** 3 * V coordinates, valid as long as the mesh. Decoded meshes hold exact float32 values. */
GVC_API const double *gvc_mesh_positions(const gvc_mesh *mesh);
/** 3 * F vertex indices, counter-clockwise seen from outside, valid as long as the mesh. */
GVC_API const uint32_t *gvc_mesh_faces(const gvc_mesh *mesh);

/** File formats of meshes. */
typedef enum gvc_mesh_format {
    GVC_MESH_AUTO = 0, /**< by file name when writing, by content and name when reading */
    GVC_MESH_OFF = 1,
    GVC_MESH_OBJ = 2,
    GVC_MESH_PLY = 3,           /**< binary little-endian when writing */
    GVC_MESH_PLY_ASCII = 4,     /**< writing only */
    GVC_MESH_PLY_BIG_ENDIAN = 5 /**< writing only */
} gvc_mesh_format;

/** Reads a mesh file; "-" is standard input (then `format` says what it is, or content does).
 *  Polygons are fanned. GVC_ERROR_IO if it cannot be read; GVC_ERROR_MESH, with line or offset in
 * the message, if it is not a mesh. */
GVC_API GVC_NODISCARD gvc_result gvc_mesh_read_file(const char *path, gvc_mesh_format format,
                                                    gvc_mesh **mesh, gvc_error *error);
/** The same from memory; `name` is used in messages only. */
GVC_API GVC_NODISCARD gvc_result gvc_mesh_read_memory(const void *data, size_t size,
                                                      gvc_mesh_format format, const char *name,
                                                      gvc_mesh **mesh, gvc_error *error);
/** Writes to a temporary name beside `path` and renames it when whole ("-": standard output).
 *  An existing file is replaced only if `overwrite`. */
GVC_API GVC_NODISCARD gvc_result gvc_mesh_write_file(const gvc_mesh *mesh, const char *path,
                                                     gvc_mesh_format format, bool overwrite,
                                                     gvc_error *error);

/** Topology of a mesh. Counts are of the mesh as given. */
typedef struct gvc_topology {
    uint64_t vertex_count;              /**< V */
    uint64_t face_count;                /**< F */
    uint64_t edge_count;                /**< pairs of vertices that share a face's side */
    uint64_t component_count;           /**< edge-connected components of faces */
    uint64_t boundary_edge_count;       /**< edges with one face */
    uint64_t boundary_loop_count;       /**< closed runs of such edges */
    uint64_t nonmanifold_edge_count;    /**< edges with more than two faces */
    uint64_t nonmanifold_vertex_count;  /**< vertices whose faces form more than one fan */
    uint64_t misoriented_edge_count;    /**< edges whose two faces run the same way */
    uint64_t degenerate_face_count;     /**< faces that repeat a vertex */
    uint64_t duplicate_face_count;      /**< faces with the same three vertices as an earlier one */
    uint64_t unreferenced_vertex_count; /**< vertices of no face */
    int64_t genus;        /**< sum over components if closed, manifold and oriented, else -1 */
    bool closed_manifold; /**< closed, manifold and oriented */
} gvc_topology;

/** Counts what `topology` has. Any mesh will do; fails only for lack of memory. */
GVC_API GVC_NODISCARD gvc_result gvc_mesh_topology(const gvc_mesh *mesh, gvc_topology *topology,
                                                   gvc_error *error);

/** Distance between two surfaces, in the unit of the meshes. Each direction takes area-weighted
 *  samples of one surface, and all its vertices for the maximum, to the other surface. */
typedef struct gvc_distance {
    double mean[2];    /**< mean distance; [0] first to second, [1] second to first */
    double rms[2];     /**< root of the mean square, likewise */
    double maximum[2]; /**< one-sided Hausdorff distance, likewise */
    double diagonal;   /**< of the first mesh's bounding box */
} gvc_distance;

/** `samples` per direction (0: 20,000). Deterministic. */
GVC_API GVC_NODISCARD gvc_result gvc_mesh_distance(const gvc_mesh *first, const gvc_mesh *second,
                                                   size_t samples, gvc_distance *distance,
                                                   gvc_error *error);

typedef struct gvc_reader gvc_reader; /**< an opened file: parsed, immutable, shareable */

/* ------------------------------------------------------------------------------------ encoding */

/** Where frames come from. The encoder reads frames more than once and from several threads at a
 *  time, so `read` must be thread-safe and give the same mesh each time. */
typedef struct gvc_source {
    void *user;           /**< passed to the functions */
    uint64_t frame_count; /**< at least 1 */
    /** Gives a new mesh, which the encoder destroys. */
    gvc_result (*read)(void *user, uint64_t frame, gvc_mesh **mesh, gvc_error *error);
    /** Name of a frame for messages and for the file's record of sources; may be NULL. */
    const char *(*name)(void *user, uint64_t frame);
} gvc_source;

/** Where the file goes: bytes strictly in order, never rewritten. */
typedef struct gvc_sink {
    void *user; /**< passed to write */
    /** Takes all `size` bytes or fails, which ends the encode. */
    gvc_result (*write)(void *user, const void *data, size_t size, gvc_error *error);
} gvc_sink;

/** What progress is told of. */
typedef enum gvc_stage {
    GVC_STAGE_SCAN = 0,  /**< all frames are read once and checked */
    GVC_STAGE_ENCODE = 1 /**< analysis and coding */
} gvc_stage;

/** How to encode. Start from gvc_encode_options_init. */
typedef struct gvc_encode_options {
    size_t struct_size; /**< set by gvc_encode_options_init */
    uint32_t
        image_size; /**< samples per side of a geometry image, 16..2049; 0: chosen for max_rms */
    double max_rms; /**< RMS error to hold in every group of frames, as a fraction of the frame's
                         bounding-box diagonal (default 1e-3); ignored if crf is given */
    double max_rms_length; /**< > 0: the same as a length in the meshes' unit, instead of max_rms */
    bool lossless;     /**< keep the geometry images exactly, as 16-bit codes. max_rms then chooses
                            the image size only: the least whose sampling error is within it */
    bool with_preview; /**< lossless, and H.264 pictures too, within max_rms or at crf */
    double crf;        /**< x264's rate factor at 10 bits, -12..51; NaN (default): from max_rms */
    bool best_effort;  /**< warn instead of failing where the error asked for is out of reach */
    uint32_t gop;      /**< frames per group (random access unit), and from keyframe to keyframe;
                            default 60 */
    uint32_t frame_rate_num; /**< default 30 */
    uint32_t frame_rate_den; /**< default 1 */
    uint32_t threads;        /**< 0: one per processor. Never changes the output */
    char unit[16];           /**< "m", "mm", or empty for unknown; recorded only */
    bool weld; /**< weld exactly equal positions where that gives a manifold; default true */
    double persistence; /**< least persistence of an extremum, of the range of mu; default 0.2 */
    double curvature_weight; /**< exponent of the curvature metric; default 0.25; 0: none */
    /* How the cut and the chart follow the surface; only experiments need other values. */
    double prior_weight;    /**< of E_p (Eq. 8), >= 0; default 1 */
    double shortest_weight; /**< of E_d (Eq. 7), >= 0; default 0.05 */
    double lambda;          /**< Eq. 10, 0..1: share of a junction's earlier place; default 0.95 */
    double interior_share;  /**< how far a chart's interior goes to where the one before it was,
                                 0..1; default 0.8 */
    bool registration;      /**< earlier places are moved along with the surface; default true */
    double longest_edge;    /**< edges are split until none is longer, in parts of the root of the
                                 surface's area, so that coarse meshes and fine ones are cut alike;
                                 > 0; default 0.024 (at least 2,000 vertices) */
    /** Called from the calling thread; return false to cancel. May be NULL. */
    bool (*progress)(void *user, gvc_stage stage, uint64_t done, uint64_t total);
    /** Warnings, one line without newline; frame or GVC_NO_FRAME. May be NULL. */
    void (*warn)(void *user, int64_t frame, const char *message);
    /** Lines of a journal, without newline, for gvc_encode_resume: one at the beginning, and one
     *  after each group of frames has gone into the sink. Called from the calling thread; a failure
     *  ends the encode. May be NULL. */
    gvc_result (*journal)(void *user, const char *line, gvc_error *error);
    /** State between two groups, some hundred kilobytes; the last one given lets gvc_encode_resume
     *  begin there. Good only for the same build on the same machine. May be NULL. */
    gvc_result (*checkpoint)(void *user, const void *data, size_t size, gvc_error *error);
    void *user; /**< passed to the callbacks */
} gvc_encode_options;

/** The defaults named in the struct. */
GVC_API void gvc_encode_options_init(gvc_encode_options *options);

/** What an encode did. */
typedef struct gvc_encode_report {
    uint64_t frame_count;   /**< frames coded */
    uint64_t segment_count; /**< runs of frames with one cut graph */
    uint64_t gop_count;     /**< groups of frames, random access units */
    uint64_t byte_count;    /**< of the file */
    uint32_t image_size;    /**< samples a side */
    double worst_rms; /**< greatest measured RMS of a group, fraction of the diagonal; of a lossless
                           file, that of the exact codes */
    double preview_rms; /**< of the preview; 0 if there is none */
    double mean_crf;    /**< 0 if there is no video */
} gvc_encode_report;

/** Encodes all frames of `source` into `sink`. `report` may be NULL. Not in decoder-only builds,
 * where it gives GVC_ERROR_UNSUPPORTED. */
GVC_API GVC_NODISCARD gvc_result gvc_encode(const gvc_source *source, const gvc_sink *sink,
                                            const gvc_encode_options *options,
                                            gvc_encode_report *report, gvc_error *error);

/** What an encode that ended early has left. */
typedef struct gvc_partial {
    const gvc_reader *file; /**< what its sink got, opened with keep_going */
    const char *journal;    /**< its lines, each with a newline */
    const void *checkpoint; /**< its last state; NULL: frames before are analysed again, which gives
                                 the same bytes, but takes most of the time of an encode */
    size_t checkpoint_size; /**< bytes */
} gvc_partial;

/** Goes on with an encode that ended early; source and options must be the same. The sink gets the
 *  file from its first byte on, and the journal all lines: the same bytes as if nothing had
 *  happened. Groups of `partial` behind its checkpoint are analysed again but not coded.
 *  GVC_ERROR_ARGUMENT if source or options are not the same. */
GVC_API GVC_NODISCARD gvc_result gvc_encode_resume(const gvc_source *source, const gvc_sink *sink,
                                                   const gvc_encode_options *options,
                                                   const gvc_partial *partial,
                                                   gvc_encode_report *report, gvc_error *error);

/* ------------------------------------------------------------------------------------ decoding */

typedef struct gvc_decoder gvc_decoder; /**< decodes frames of one reader; one thread at a time */

/** Random-access input. `read` fills exactly `size` bytes at `offset` or fails. Must be thread-safe
 *  if the reader is shared. */
typedef struct gvc_io {
    void *user;    /**< passed to read */
    uint64_t size; /**< of the file, in bytes */
    /** Fills all of `data` or fails. */
    gvc_result (*read)(void *user, uint64_t offset, void *data, size_t size, gvc_error *error);
} gvc_io;

/** Limits, and what to decode. Start from gvc_read_options_init. */
typedef struct gvc_read_options {
    size_t struct_size;      /**< set by gvc_read_options_init */
    uint64_t max_memory;     /**< bytes that a reader and one of its decoders may hold together,
                                  codecs included (docs/limits.md); default 1 GiB */
    uint32_t max_image_size; /**< samples per side; default 2049 */
    uint64_t max_frames;     /**< default 10,000,000 */
    bool keep_going; /**< accept a damaged or cut-off file and index every whole fragment of it */
    bool preview;    /**< of a lossless file that has a preview, decode that (H.264, lossy, fast)
                          instead of the exact codes; a file that is lossy is decoded as ever */
} gvc_read_options;

/** The defaults named in the struct. */
GVC_API void gvc_read_options_init(gvc_read_options *options);

/** `options` may be NULL for defaults. The file stays open until gvc_reader_close. */
GVC_API GVC_NODISCARD gvc_result gvc_reader_open_file(const char *path,
                                                      const gvc_read_options *options,
                                                      gvc_reader **reader, gvc_error *error);
/** `data` is borrowed and must outlive the reader. */
GVC_API GVC_NODISCARD gvc_result gvc_reader_open_memory(const void *data, size_t size,
                                                        const gvc_read_options *options,
                                                        gvc_reader **reader, gvc_error *error);
/** `io` is copied; what it refers to must outlive the reader. */
GVC_API GVC_NODISCARD gvc_result gvc_reader_open_io(const gvc_io *io,
                                                    const gvc_read_options *options,
                                                    gvc_reader **reader, gvc_error *error);
/** Frees the reader and nulls the pointer. Decoders made from it must be closed before. */
GVC_API void gvc_reader_close(gvc_reader **reader);

/** Facts about a file. */
typedef struct gvc_info {
    uint16_t format_version_major; /**< of the format (gvc.md, 5) */
    uint16_t format_version_minor; /**< of the format */
    uint64_t frame_count;          /**< frames present (whole) */
    uint64_t declared_count;       /**< frames the file says it should have; 0 if unknown */
    uint64_t byte_count;           /**< of the file */
    uint32_t image_size;           /**< greatest number of samples a side of a chart */
    uint32_t picture_width;        /**< samples */
    uint32_t picture_height;       /**< rows: three planes */
    uint32_t level; /**< 1..6: how large pictures are, and how many a second (gvc.md, 13.4) */
    uint32_t frame_rate_num; /**< frames per second: frame_rate_num / frame_rate_den */
    uint32_t frame_rate_den; /**< at least 1 */
    uint64_t gop_count;      /**< groups of frames present */
    uint64_t damage_count;   /**< damaged places found while opening with keep_going */
    bool lossless;           /**< there is an exact track: frames are decoded to its 16-bit codes */
    bool preview;            /**< a lossless file that has H.264 pictures, too */
    uint64_t geometry_bytes; /**< of all pictures */
    uint64_t shape_bytes;    /**< of all shape records */
    uint64_t exact_bytes;    /**< of all exact images */
    uint64_t lost_count;     /**< frames that the file says were lost before it was repaired */
    uint8_t digest[32];      /**< SHA-256 at the end of the file, of all bytes before it */
    bool has_digest;         /**< false only for a damaged or cut-off file */
    char unit[16];           /**< of the coordinates; empty if not stated */
    char encoder[64];        /**< program that wrote the file */
} gvc_info;

/** Facts about the file as it was opened. */
GVC_API void gvc_reader_info(const gvc_reader *reader, gvc_info *info);

/** Facts about one frame, without decoding its picture. */
typedef struct gvc_frame_info {
    uint64_t byte_count;     /**< of all its samples */
    uint64_t segment;        /**< index of its segment */
    uint32_t chart_count;    /**< at least 1 */
    uint32_t genus;          /**< summed over charts */
    uint32_t extremum_count; /**< nodes of the cut graph that are extrema */
    uint32_t node_count;     /**< of the cut graphs of all charts */
    uint32_t edge_count;     /**< of the cut graphs of all charts */
    bool keyframe;           /**< starts a group of frames */
    char source[64]; /**< name of the original frame; the encoder here names the first of a group */
    uint8_t digest[8]; /**< of the decoded codes and faces; with read_options.preview those of the
                            preview, if there is one */
} gvc_frame_info;

/** GVC_ERROR_LOST for a frame that a repaired file says is lost, GVC_ERROR_ARGUMENT for one beyond
 * the end, GVC_ERROR_CORRUPT or _TRUNCATED for one that is damaged. */
GVC_API GVC_NODISCARD gvc_result gvc_reader_frame_info(const gvc_reader *reader, uint64_t frame,
                                                       gvc_frame_info *info, gvc_error *error);

/** A decoder of all frames of `reader`, which must outlive it. */
GVC_API GVC_NODISCARD gvc_result gvc_decoder_create(const gvc_reader *reader, gvc_decoder **decoder,
                                                    gvc_error *error);
/** Frees the decoder and nulls the pointer. */
GVC_API void gvc_decoder_destroy(gvc_decoder **decoder);

/** Decodes one frame in any order (in order is fastest) to a closed mesh, which the caller
 * destroys. The checksums of all samples used and the frame's digest are verified. After a failure
 * the decoder can be used for other frames. */
GVC_API GVC_NODISCARD gvc_result gvc_decoder_frame(gvc_decoder *decoder, uint64_t frame,
                                                   gvc_mesh **mesh, gvc_error *error);

/* ------------------------------------------------------------------------ damage and its repair */

/** Part of a file that a defect is in. */
typedef enum gvc_part {
    GVC_PART_HEAD = 0,     /**< ftyp or moov */
    GVC_PART_FRAGMENT = 1, /**< moof, or the header of mdat */
    GVC_PART_GEOMETRY = 2, /**< a picture */
    GVC_PART_SHAPE = 3,    /**< a shape record */
    GVC_PART_EXACT = 4,    /**< an exact image */
    GVC_PART_INDEX = 5,    /**< mfra, or the end of the file */
    GVC_PART_FILE = 6      /**< somewhere outside of what checksums cover */
} gvc_part;

/** A damaged place of a file. */
typedef struct gvc_defect {
    gvc_part part;   /**< where it is */
    uint64_t offset; /**< from the start of the file, bytes */
    uint64_t size;   /**< bytes; 0 if something is missing there */
    uint32_t
        first_fragment;     /**< fragments it lies in, numbered as the file does, from 1; 0: none */
    uint32_t last_fragment; /**< 0: not known, of a run of lost fragments that reaches the end */
    /** Frames it is part of. Of GVC_PART_FRAGMENT and GVC_PART_INDEX, those that are lost with it.
     * Of a picture or record others may depend on it; decoding tells. */
    uint64_t first_frame;
    uint64_t frame_count; /**< how many, from first_frame on */
    gvc_error error;      /**< what is wrong */
} gvc_defect;

/** Looks at every byte of a file without decoding it: structure, checksums of all samples, digest
 * of the file. Calls `found` for each defect in the order of the file; it returns false to stop
 *  (GVC_ERROR_CANCELLED). Open the file with keep_going. GVC_OK if all was looked at, whether good
 * or not. */
GVC_API GVC_NODISCARD gvc_result gvc_reader_check(const gvc_reader *reader,
                                                  bool (*found)(void *user,
                                                                const gvc_defect *defect),
                                                  void *user, gvc_error *error);

/** What a repair did. */
typedef struct gvc_repair_report {
    uint64_t frame_count;  /**< frames saved */
    uint64_t lost_count;   /**< frames lost, those lost before among them */
    uint64_t whole_groups; /**< copied bit for bit */
    uint64_t cut_groups;   /**< of which frames before the damage were saved */
    uint64_t byte_count;   /**< of the new file */
} gvc_repair_report;

/** Writes a good file of what is undamaged in another, which should have been opened with
 * keep_going. Nothing is decoded or coded again: groups that are whole are copied, of others the
 * frames before the damage are kept as far as they need nothing behind it. Frames keep their
 * numbers, and so their times; the file states which are lost. `lost` (may be NULL) is called for
 * each run of frames lost now. GVC_ERROR_CORRUPT if there is nothing to save. `report` may be NULL.
 */
GVC_API GVC_NODISCARD gvc_result gvc_repair(const gvc_reader *reader, const gvc_sink *sink,
                                            void (*lost)(void *user, uint64_t first_frame,
                                                         uint64_t frame_count),
                                            void *user, gvc_repair_report *report,
                                            gvc_error *error);

#ifdef __cplusplus
}
#endif
#endif
