/* SPDX-License-Identifier: MIT */
/** @file compare.h  What `gvc compare` measures: bytes, errors and CPU time of ways to code frames.
 */
#ifndef GVC_TOOLS_COMPARE_H
#define GVC_TOOLS_COMPARE_H

#include "base/bytes.h"
#include "gvc/gvc.h"

/** One frame coded one way. Errors are fractions of the original's bounding-box diagonal, each the
 *  worse of the two directions. */
typedef struct compare_frame {
    uint64_t bytes;
    double mean, rms, hausdorff;
    double encode_seconds, decode_seconds; /**< CPU time */
} compare_frame;

/** One line of the comparison: all frames coded one way. NaN: not measured. */
typedef struct compare_row {
    char method[48]; /**< such as "zip -9" or "draco qp 10" */
    uint64_t frames;
    double bytes;                          /**< per frame, everything in the file counted */
    double mean;                           /**< mean over the frames */
    double rms;                            /**< root mean square over the frames */
    double hausdorff_max, hausdorff_mean;  /**< greatest and mean over the frames */
    double encode_seconds, decode_seconds; /**< CPU time per frame, reading the frames left out */
} compare_row;

typedef struct compare_options {
    unsigned threads; /**< to measure frames with; 0: one per processor. No effect on results */
    size_t samples;   /**< per direction of a distance; 0: as gvc_mesh_distance */
} compare_options;

/* All methods read frames through a gvc_source, one or a few at a time, so that a capture need not
 * fit into memory. A failure of a frame names the frame. On failure `row` is untouched. */

/** Measures `decoded` against `original` and sets the errors of `frame`, nothing else. */
gvc_result compare_measure(const gvc_mesh *original, const gvc_mesh *decoded, size_t samples,
                           compare_frame *frame, gvc_error *error);

/** Sums up frames as compare_row says; `count` > 0. */
void compare_summarise(const char *method, const compare_frame *frames, uint64_t count,
                       compare_row *row);

/** One zip archive of OFF files. Lossless, so the errors are 0. `original` may give the bytes of a
 * frame that came as an OFF file; it leaves the buffer empty for a frame that did not, whose OFF
 * text is then made (compare_off_text). It may be NULL and gets source->user. */
gvc_result compare_zip(const gvc_source *source,
                       gvc_result (*original)(void *user, uint64_t frame, gvc_buffer *bytes,
                                              gvc_error *error),
                       compare_row *row, gvc_error *error);

/** Draco, every frame by itself, `bits` per coordinate (1..30), level 10. */
gvc_result compare_draco(const gvc_source *source, int bits, const compare_options *options,
                         compare_row *row, gvc_error *error);

/** This format, through the public interface, to and from memory. `method` names the row. */
gvc_result compare_gvc(const gvc_source *source, const char *method,
                       const gvc_encode_options *encode, const compare_options *options,
                       compare_row *row, gvc_error *error);

/** A way to encode: gvc_encode, or one that does more. */
typedef gvc_result (*compare_encoder)(void *user, const gvc_source *source, const gvc_sink *sink,
                                      const gvc_encode_options *options, gvc_error *error);

/** Encodes to memory; `*seconds` is the CPU time without that of reading the frames. */
gvc_result compare_encode(const gvc_source *source, const gvc_encode_options *options,
                          compare_encoder encode, void *user, gvc_buffer *file, double *seconds,
                          gvc_error *error);

/** Decodes a `.gvc` file, measures each frame against that of `source` and sets errors and decoding
 * time in `frames`, one per frame of the source, nothing else. */
gvc_result compare_decode(const gvc_source *source, const gvc_buffer *file,
                          const compare_options *options, compare_frame *frames, gvc_error *error);

/* Printers append to `text`; out of memory shows in `text->failed`. They do not depend on the
 * locale.
 */

/** Aligned columns for a person: errors in 1e-4 of the diagonal, times in ms; "-": not measured. */
void compare_print_table(const compare_row *rows, size_t count, gvc_buffer *text);
/** {"rows": [{...}]} with the keys method, frames, bytes_per_frame, mean, rms, hausdorff_max,
 *  hausdorff_mean, encode_seconds, decode_seconds; full precision, fractions, null: not measured.
 */
void compare_print_json(const compare_row *rows, size_t count, gvc_buffer *text);
/** RFC 4180 with a header line of the same names; empty: not measured. Lines end in a plain LF. */
void compare_print_csv(const compare_row *rows, size_t count, gvc_buffer *text);

#endif
