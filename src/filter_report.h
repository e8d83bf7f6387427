/* What a filter gains, as tables: triangles of the recursive subdivision of squares (lod/square_subdivision.h). Pure.
 *
 * After Tables 2 to 4 of S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of terrain data based on
 * multi scale analysis" (GRAPP 2015). */
#ifndef SCREE_FILTER_REPORT_H
#define SCREE_FILTER_REPORT_H

#include "lod/context_filter.h"
#include "src/text.h"

#define REPORT_STEPS 6 /* spline steps that are compared: 1 to this */

/* Adds the tables to `text`: the posts filtered as `options` say, with both variants, with other numbers of spline
 * steps and other deltas. `room_m` holds as many heights as there are posts. */
enum scree_status filter_report(struct scree_memory *memory, const struct context_posts *posts,
                                const struct context_options *options, float *room_m, struct text *text,
                                struct scree_error *error);

#endif
