/* Where the points of a tile lie: in its own frame in metres, and its frame in the world (scree/stream.h). */
#include "stream/ellipsoid.h"
#include <scree/stream.h>

/* Whatever a header or a caller says: an angle that has a sine. No tile is a million degrees from anywhere. */
static double bounded_deg(double angle_deg) {
    const double most_deg = 1e6;
    if (!(angle_deg > -most_deg)) return -most_deg;
    return angle_deg > most_deg ? most_deg : angle_deg;
}

static struct east_north_up directions(const struct scree_stream_header *header, double x, double y) {
    return ellipsoid_frame(bounded_deg(header->west + x * header->spacing_x),
                           bounded_deg(header->south + y * header->spacing_y));
}

static void store(struct vector3 from, double to[3]) {
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

static double along(const double axis[3], const double vector[3]) {
    return axis[0] * vector[0] + axis[1] * vector[1] + axis[2] * vector[2];
}

void scree_stream_frame(const struct scree_stream_header *header, struct scree_frame *frame) {
    double x = 0.5 * header->columns, y = 0.5 * header->rows;
    *frame = (struct scree_frame){.axes = {{0}}};
    if (header->profile == SCREE_GEODETIC) {
        struct east_north_up middle = directions(header, x, y);
        store(ellipsoid_point(middle.up, 0), frame->origin);
        store(middle.east, frame->axes[0]);
        store(middle.north, frame->axes[1]);
        store(middle.up, frame->axes[2]);
    } else {
        frame->origin[0] = header->west + x * header->spacing_x;
        frame->origin[1] = header->south + y * header->spacing_y;
        frame->axes[0][0] = header->spacing_x / header->metres_x;
        frame->axes[1][1] = header->spacing_y / header->metres_y;
        frame->axes[2][2] = 1;
    }
}

void scree_stream_position(const struct scree_stream_header *header, const struct scree_frame *frame, double x,
                           double y, double height_m, double position_m[3]) {
    if (header->profile == SCREE_GEODETIC) {
        double from_origin[3];
        store(ellipsoid_point(directions(header, x, y).up, height_m), from_origin);
        for (int i = 0; i < 3; i++) from_origin[i] -= frame->origin[i];
        for (int i = 0; i < 3; i++) position_m[i] = along(frame->axes[i], from_origin);
    } else {
        position_m[0] = (x - 0.5 * header->columns) * header->metres_x;
        position_m[1] = (y - 0.5 * header->rows) * header->metres_y;
        position_m[2] = height_m;
    }
}
