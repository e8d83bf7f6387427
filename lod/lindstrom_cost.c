#include "lod/lindstrom_cost.h"

#include <math.h>

#define COS2_ALPHA 0.99969541350954788 /* of one degree, squared */
#define SIN2_ALPHA 0.00030458649045213 /* the same of its sine */
#define NOTHING    1e-12               /* share of a hessian's size below which a row of it is rounding */

static inline double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross(const double a[3], const double b[3], double product[3]) {
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

/* Of the symmetric matrix whose upper half is h. */
static inline void times(const double h[6], const double v[3], double product[3]) {
    product[0] = h[0] * v[0] + h[1] * v[1] + h[2] * v[2];
    product[1] = h[1] * v[0] + h[3] * v[1] + h[4] * v[2];
    product[2] = h[2] * v[0] + h[4] * v[1] + h[5] * v[2];
}

void lindstrom_add_triangle(struct lindstrom_sums *sums, const double corner[3], const double edge[3],
                            const double other_edge[3]) {
    double n[3];
    cross(edge, other_edge, n);
    double offset = dot(n, corner);
    for (int i = 0; i < 3; i++) {
        sums->normal[i] += n[i];
        sums->gradient[i] += offset * n[i];
    }
    sums->offset += offset;
    sums->constant += offset * offset;
    sums->hessian[0] += n[0] * n[0];
    sums->hessian[1] += n[0] * n[1];
    sums->hessian[2] += n[0] * n[2];
    sums->hessian[3] += n[1] * n[1];
    sums->hessian[4] += n[1] * n[2];
    sums->hessian[5] += n[2] * n[2];
}

/* The squared length of m - v x e, with e = to - from and m = from x to, as a quadratic form of v. */
void lindstrom_add_border(struct lindstrom_sums *sums, const double from[3], const double to[3]) {
    double e[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, m[3], em[3];
    cross(from, to, m);
    cross(e, m, em);
    double square = dot(e, e);
    sums->border_hessian[0] += square - e[0] * e[0];
    sums->border_hessian[1] -= e[0] * e[1];
    sums->border_hessian[2] -= e[0] * e[2];
    sums->border_hessian[3] += square - e[1] * e[1];
    sums->border_hessian[4] -= e[1] * e[2];
    sums->border_hessian[5] += square - e[2] * e[2];
    for (int i = 0; i < 3; i++) sums->border_gradient[i] += em[i];
    sums->border += dot(m, m);
}

void lindstrom_add_neighbour(struct lindstrom_sums *sums, const double at[3]) {
    for (int i = 0; i < 3; i++) sums->link[i] += at[i];
    sums->link_squares += dot(at, at);
    sums->link_count++;
}

/* The planes found so far: normal . place = offset, with unit normals. */
struct planes {
    int count;
    double normal[3][3], offset[3];
};

static void add_plane(struct planes *planes, const double normal[3], double offset) {
    double square = dot(normal, normal);
    if (planes->count == 3 || !(square > 0) || !isfinite(square)) return;
    double scale = 1 / sqrt(square), unit[3] = {normal[0] * scale, normal[1] * scale, normal[2] * scale};
    if (planes->count == 1) {
        double along = dot(planes->normal[0], unit);
        if (along * along >= COS2_ALPHA) return;
    } else if (planes->count == 2) {
        double line[3];
        cross(planes->normal[0], planes->normal[1], line);
        double along = dot(line, unit);
        if (along * along <= SIN2_ALPHA * dot(line, line)) return;
    }
    for (int i = 0; i < 3; i++) planes->normal[planes->count][i] = unit[i];
    planes->offset[planes->count++] = offset * scale;
}

/* Where the quadratic form of h and c is least within what the planes leave open: a plane for each open direction. */
static void add_least(struct planes *planes, const double h[6], const double c[3]) {
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double open[3][3], row[3], size = h[0] + h[3] + h[5];
    int count = 3 - planes->count;
    if (count == 2) {
        const double *n = planes->normal[0];
        int largest = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
        if (fabs(n[2]) > fabs(n[largest])) largest = 2;
        cross(n, axes[(largest + 1) % 3], open[0]);
        cross(n, open[0], open[1]);
    } else if (count == 1) {
        cross(planes->normal[0], planes->normal[1], open[0]);
    }
    for (int i = 0; i < count; i++) {
        const double *direction = count == 3 ? axes[i] : open[i];
        times(h, direction, row);
        if (dot(row, row) <= NOTHING * NOTHING * size * size) continue;
        add_plane(planes, row, dot(direction, c));
    }
}

bool lindstrom_place(const struct lindstrom_sums *sums, double place[3]) {
    struct planes planes = {0};
    add_plane(&planes, sums->normal, sums->offset);
    add_least(&planes, sums->hessian, sums->gradient);
    if (planes.count < 3) {
        double count = sums->link_count;
        add_least(&planes, (double[6]){count, 0, 0, count, 0, count}, sums->link);
    }
    if (planes.count < 3) return false;
    double bc[3], ca[3], ab[3];
    cross(planes.normal[1], planes.normal[2], bc);
    cross(planes.normal[2], planes.normal[0], ca);
    cross(planes.normal[0], planes.normal[1], ab);
    double scale = 1 / dot(planes.normal[0], bc);
    for (int i = 0; i < 3; i++)
        place[i] = (planes.offset[0] * bc[i] + planes.offset[1] * ca[i] + planes.offset[2] * ab[i]) * scale;
    return isfinite(place[0] + place[1] + place[2]);
}

static double form(const double h[6], const double c[3], double constant, const double at[3]) {
    double row[3];
    times(h, at, row);
    return fmax(dot(row, at) - 2 * dot(c, at) + constant, 0);
}

double lindstrom_cost(const struct lindstrom_sums *sums, const struct lindstrom_weights *weights, double squared_length,
                      const double place[3]) {
    double volume = form(sums->hessian, sums->gradient, sums->constant, place) / 36;
    double border = form(sums->border_hessian, sums->border_gradient, sums->border, place) / 4;
    double cost = weights->volume * volume + weights->boundary * border * squared_length;
    if (!(weights->shape > 0)) return cost;
    double count = sums->link_count;
    double lengths = form((double[6]){count, 0, 0, count, 0, count}, sums->link, sums->link_squares, place);
    return cost + weights->shape * lengths * squared_length * squared_length;
}
