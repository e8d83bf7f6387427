/* What verify found, on standard output: a table for people, or members of a JSON object for machines. */
#ifndef SCREE_VERIFY_PRINT_IO_H
#define SCREE_VERIFY_PRINT_IO_H

#include "src/json_text.h"
#include "src/terrain_set_io.h"
#include "src/verify_against_io.h"
#include "src/verify_report.h"

/* `against->zooms` is NULL when nothing was measured. `quiet`: only what is broken. */
void verify_print_text(const struct terrain_set *set, const struct verify_report *report, const struct against *against,
                       bool quiet);

/* The members of an object that is open. */
void verify_put_terrain(struct json_text *json, const struct terrain_set *set, const struct verify_report *report,
                        const struct against *against);

/* What all products have in common: the table of promises, the line that sums up, the member "promises". */
void verify_print_promises(const struct verify_report *report, bool quiet);
void verify_print_end(const struct verify_report *report);
void verify_put_promises(struct json_text *json, const struct verify_report *report);

#endif
