/* SPDX-License-Identifier: MIT */
/** @file result.h  Reporting failures: every layer returns gvc_result and fills a gvc_error. */
#ifndef GVC_BASE_RESULT_H
#define GVC_BASE_RESULT_H

#include "gvc/gvc.h"

/** Fills `error` (may be NULL) with code and printf-style message, frame and offset unknown, and
 *  returns `code`. Usage: `return gvc_fail(error, GVC_ERROR_MESH, "...")`. */
gvc_result gvc_fail(gvc_error *error, gvc_result code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/** The usual out-of-memory failure. */
gvc_result gvc_fail_memory(gvc_error *error);

/** Adds the frame to an error unless one is there already; returns `result`, so it can wrap a call.
 */
gvc_result gvc_at_frame(gvc_error *error, gvc_result result, int64_t frame);

/** Puts the file name in error->where (its end, if it is long); returns error's code `result`. */
gvc_result gvc_fail_in(gvc_error *error, gvc_result result, const char *name);

/** GVC_ERROR_IO: "cannot <action>: <text of the errno value>", in file `name`. */
gvc_result gvc_fail_errno(gvc_error *error, const char *action, int number, const char *name);

/** Fills the code and message of a failed result that came without, as from a caller's callback
 * that does not explain itself; returns `result`. */
gvc_result gvc_explain(gvc_error *error, gvc_result result);

/** For what is tried, and may fail without harm: its own error `trouble` becomes `error` if that is
 * how the whole ends. Returns `result`; leaves `error` alone if that is GVC_OK. */
gvc_result gvc_hand_on(gvc_error *error, gvc_result result, const gvc_error *trouble);

/** Returns early with a failed result; use only where nothing has to be freed. */
#define GVC_TRY(expression)                                                                        \
    do {                                                                                           \
        gvc_result gvc_try_result_ = (expression);                                                 \
        if (gvc_try_result_ != GVC_OK) return gvc_try_result_;                                     \
    } while (0)

/** Jumps to `cleanup` with the failed result in the variable `result`. */
#define GVC_CHECK(expression)                                                                      \
    do {                                                                                           \
        result = (expression);                                                                     \
        if (result != GVC_OK) goto cleanup;                                                        \
    } while (0)

#endif
