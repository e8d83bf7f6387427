#include "lod/tin.h"

void tin_release(struct tin *tin) {
    scree_release(tin->memory, tin->corners);
    scree_release(tin->memory, tin->points);
    *tin = (struct tin){.memory = tin->memory};
}

enum scree_status tin_drop_unused(struct tin *tin, uint32_t *dropped, struct scree_error *error) {
    const size_t corner_count = 3 * (size_t)tin->triangle_count;
    uint32_t kept = 0;
    uint32_t *number = /* 1 for a point in use, then its new number */
        scree_allocate(tin->memory, tin->point_count, sizeof *number, "the numbers of a TIN's points", error);
    if (number == NULL) return error->status;
    for (size_t i = 0; i < corner_count; i++) number[tin->corners[i]] = 1;
    for (uint32_t p = 0; p < tin->point_count; p++) {
        if (number[p] == 0) continue;
        tin->points[kept] = tin->points[p];
        number[p] = kept++;
    }
    for (size_t i = 0; i < corner_count; i++) tin->corners[i] = number[tin->corners[i]];
    if (dropped != NULL) *dropped = tin->point_count - kept;
    tin->point_count = kept;
    scree_release(tin->memory, number);
    return SCREE_OK;
}
