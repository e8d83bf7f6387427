/* What a stream's header tells by itself (scree/stream.h). */
#include <scree/stream.h>

#include "stream/stream_header.h"

enum scree_status scree_stream_header_read(const void *bytes, size_t size_bytes, struct scree_stream_header *header,
                                           struct scree_error *error) {
    return stream_header_read(bytes, size_bytes, header, error);
}

uint32_t scree_stream_rung_of_svo(const struct scree_stream_header *header, double svo_m) {
    uint32_t i = 0;
    while (i + 1 < header->rung_count && !(header->rungs[i].svo_m <= svo_m)) i++;
    return i;
}

uint32_t scree_stream_rung_of_error(const struct scree_stream_header *header, double max_error_m) {
    uint32_t i = 0;
    while (i + 1 < header->rung_count && !(header->rungs[i].max_error_m <= max_error_m)) i++;
    return i;
}

uint32_t scree_stream_rung_of_ladder(const struct scree_stream_header *header, int32_t rung) {
    uint32_t i = 0;
    while (i + 1 < header->rung_count && header->rungs[i].rung < rung) i++;
    return i;
}
