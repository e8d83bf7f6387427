/* Cameras (include/scree/select.h): from a matrix to planes, depths and pixels a metre.
 *
 * With the matrix's rows r0, r1, r3 for x, y and w, a place p is seen at x = (r0 p) / (r3 p). A metre along u, parallel
 * to the screen (r3 u = 0), is |W/2 r0 u, H/2 r1 u| / w pixels long there, in perspective (w grows with depth) as well
 * as orthogonally (r3 = 0, w is the same everywhere). So the largest singular value of those two rows, without what
 * they have of r3, over w is all that scale depends on; no distance is needed for it. */
#include <scree/select.h>

#include <math.h>
#include <stdbool.h>

#define LEAST_SINE 1e-9 /* between the screen's axes: less is no projection */

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double product[3]) {
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

static double length(const double a[3]) {
    return sqrt(dot(a, a));
}

static bool all_finite(const double *values, int count) {
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

/* What of a row is parallel to the screen. */
static void flatten(const double row[4], const double direction[3], double flat[3]) {
    double along = dot(row, direction);
    for (int i = 0; i < 3; i++) flat[i] = row[i] - along * direction[i];
}

/* The largest singular value of two rows. */
static double stretch(const double a[3], const double b[3], double scale_a, double scale_b) {
    double aa = scale_a * scale_a * dot(a, a), bb = scale_b * scale_b * dot(b, b), ab = scale_a * scale_b * dot(a, b);
    return sqrt((aa + bb) / 2 + sqrt((aa - bb) * (aa - bb) / 4 + ab * ab));
}

static void set_planes(double rows[4][4], enum scree_depth depth, struct scree_view *view) {
    view->plane_count = depth == SCREE_DEPTH_ANY ? 5 : 6;
    for (int i = 0; i < 4; i++) {
        for (int axis = 0; axis < 2; axis++) {
            view->planes[2 * axis][i] = rows[3][i] + rows[axis][i];
            view->planes[2 * axis + 1][i] = rows[3][i] - rows[axis][i];
        }
        view->planes[4][i] = rows[3][i]; /* not behind the eye */
        if (depth == SCREE_DEPTH_ZERO) view->planes[4][i] = rows[2][i];
        if (depth == SCREE_DEPTH_MINUS_ONE) view->planes[4][i] += rows[2][i];
        view->planes[5][i] = rows[3][i] - rows[2][i];
    }
}

/* The place where x, y and w are 0, by Cramer's rule. */
static void find_eye(double rows[4][4], double eye[3]) {
    double products[3][3];
    cross(rows[1], rows[3], products[0]);
    cross(rows[3], rows[0], products[1]);
    cross(rows[0], rows[1], products[2]);
    double determinant = dot(rows[0], products[0]);
    for (int i = 0; i < 3; i++)
        eye[i] =
            -(rows[0][3] * products[0][i] + rows[1][3] * products[1][i] + rows[3][3] * products[2][i]) / determinant;
}

static double find_corner_cosine(double rows[4][4], const double direction[3]) {
    double least = 1;
    for (int corner = 0; corner < 4; corner++) {
        double x = corner % 2 * 2 - 1, y = corner / 2 * 2 - 1, across[3], up[3], ray[3];
        for (int i = 0; i < 3; i++) {
            across[i] = rows[0][i] - x * rows[3][i];
            up[i] = rows[1][i] - y * rows[3][i];
        }
        cross(across, up, ray);
        double cosine = fabs(dot(ray, direction)) / length(ray);
        if (cosine < least) least = cosine;
    }
    return least;
}

enum scree_status scree_view_of_matrix(const double matrix[16], enum scree_depth depth, double width_px,
                                       double height_px, struct scree_view *view, struct scree_error *error) {
    double rows[4][4], flat[2][3], normal[3];
    *view = (struct scree_view){0};
    if (!(width_px > 0) || !(height_px > 0) || !isfinite(width_px) || !isfinite(height_px))
        return scree_fail(error, SCREE_E_ARGUMENT, "a viewport of %g x %g pixels shows nothing", width_px, height_px);
    if (!all_finite(matrix, 16))
        return scree_fail(error, SCREE_E_ARGUMENT, "the view-projection matrix has a member that is not a number");
    for (int i = 0; i < 16; i++) rows[i % 4][i / 4] = matrix[i];
    view->slope = length(rows[3]);
    if (view->slope == 0 && rows[3][3] < 0) /* the same projection with all signs turned */
        for (int i = 0; i < 16; i++) rows[i % 4][i / 4] = -matrix[i];
    for (int i = 0; i < 3 && view->slope > 0; i++) view->direction[i] = rows[3][i] / view->slope;
    for (int axis = 0; axis < 2; axis++) flatten(rows[axis], view->direction, flat[axis]);
    cross(flat[0], flat[1], normal);
    if (!(length(normal) > LEAST_SINE * length(flat[0]) * length(flat[1])) || (view->slope == 0 && rows[3][3] == 0))
        return scree_fail(error, SCREE_E_ARGUMENT, "the view-projection matrix projects onto less than a plane");
    set_planes(rows, depth, view);
    for (int i = 0; i < 4; i++) {
        view->depth[i] = rows[3][i];
        for (int axis = 0; axis < 2; axis++) view->axis[axis][i] = rows[axis][i] / length(rows[axis]);
    }
    view->pixels = stretch(flat[0], flat[1], width_px / 2, height_px / 2);
    if (view->slope > 0) {
        find_eye(rows, view->eye);
        view->corner_cosine = find_corner_cosine(rows, view->direction);
    }
    if (!isfinite(view->pixels) || !(view->pixels > 0) || !all_finite(view->eye, 3) || !isfinite(view->corner_cosine))
        return scree_fail(error, SCREE_E_ARGUMENT, "the view-projection matrix has members too large or too small");
    return SCREE_OK;
}

enum scree_status scree_view_of_eye(const double eye[3], double field_of_view_rad, double height_px,
                                    struct scree_view *view, struct scree_error *error) {
    *view = (struct scree_view){.slope = 1, .corner_cosine = 1};
    if (!all_finite(eye, 3)) return scree_fail(error, SCREE_E_ARGUMENT, "the camera's place is not a number");
    if (!(field_of_view_rad > 0) || !(field_of_view_rad < acos(-1.0)) || !(height_px > 0) || !isfinite(height_px))
        return scree_fail(error, SCREE_E_ARGUMENT, "%g pixels over a field of view of %g rad show nothing", height_px,
                          field_of_view_rad);
    for (int i = 0; i < 3; i++) view->eye[i] = eye[i];
    view->pixels = height_px / (2 * tan(field_of_view_rad / 2));
    return SCREE_OK;
}
