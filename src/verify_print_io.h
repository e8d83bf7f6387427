/* What verify found, on standard output: a table for people, or JSON for machines. */
#ifndef SCREE_VERIFY_PRINT_IO_H
#define SCREE_VERIFY_PRINT_IO_H

#include "src/terrain_set_io.h"
#include "src/verify_against_io.h"
#include "src/verify_report.h"
#include <scree/error.h>

/* `against->zooms` is NULL when nothing was measured. `quiet`: only what is broken. */
void verify_print_text(const struct terrain_set *set, const struct verify_report *report, const struct against *against,
                       bool quiet);
enum scree_status verify_print_json(const struct terrain_set *set, const struct verify_report *report,
                                    const struct against *against, struct scree_error *error);

#endif
