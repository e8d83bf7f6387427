/* What verify found about streams, on standard output: a table for people, or members of a JSON object. */
#ifndef SCREE_VERIFY_STREAM_PRINT_IO_H
#define SCREE_VERIFY_STREAM_PRINT_IO_H

#include "src/json_text.h"
#include "src/stream_set_io.h"
#include "src/verify_report.h"
#include "src/verify_stream_against_io.h"

/* `against->zooms` is NULL when nothing was measured. `quiet`: only what is broken. */
void verify_print_streams(const struct stream_set *set, const struct verify_report *report,
                          const struct stream_against *against, bool quiet);

/* An object without a key. */
void verify_put_streams(struct json_text *json, const struct stream_set *set, const struct verify_report *report,
                        const struct stream_against *against);

#endif
