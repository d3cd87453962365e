/* SPDX-License-Identifier: MIT */
/** @file require.h  What every harness demands of libgvc besides not crashing. */
#ifndef GVC_FUZZ_REQUIRE_H
#define GVC_FUZZ_REQUIRE_H

#include "gvc/gvc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Ends the run where `condition` does not hold: a finding. */
#define REQUIRE(condition)                                                                         \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition);         \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

/** Whether a call succeeded. Its error must be filled if, and only if, it failed, and no input may
 * uncover a bug in the library. `error` must come from gvc_error_init; it is made ready for the
 * next call. */
static inline bool succeeded(gvc_result result, gvc_error *error) {
    if (result == GVC_OK) {
        REQUIRE(error->code == GVC_OK && error->message[0] == '\0');
        return true;
    }
    if (result == GVC_ERROR_INTERNAL) fprintf(stderr, "%s\n", error->message);
    REQUIRE(result != GVC_ERROR_INTERNAL);
    REQUIRE(error->code == result && error->message[0] != '\0');
    REQUIRE(memchr(error->message, '\0', sizeof error->message) != NULL);
    REQUIRE(memchr(error->where, '\0', sizeof error->where) != NULL);
    gvc_error_init(error);
    return false;
}

/** Whether this may be said of bytes alone: neither the system nor the caller did anything wrong.
 */
static inline bool blames_input(gvc_result result) {
    return result == GVC_ERROR_CORRUPT || result == GVC_ERROR_TRUNCATED ||
           result == GVC_ERROR_UNSUPPORTED || result == GVC_ERROR_LIMIT || result == GVC_ERROR_LOST;
}

#endif
