#include "lod/covariance.h"

#include <math.h>

#define SWEEPS 12 /* convergence is quadratic: four or five are enough for a 3 x 3 matrix */

/* Turns the plane of axes p and q so that the matrix has no entry there any more. */
static void rotate(double a[3][3], double v[3][3], int p, int q) {
    if (a[p][q] == 0) return;
    double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    double tangent = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
    double cosine = 1 / sqrt(tangent * tangent + 1), sine = tangent * cosine;
    for (int k = 0; k < 3; k++) {
        double kp = a[k][p], kq = a[k][q];
        a[k][p] = cosine * kp - sine * kq;
        a[k][q] = sine * kp + cosine * kq;
    }
    for (int k = 0; k < 3; k++) {
        double pk = a[p][k], qk = a[q][k];
        a[p][k] = cosine * pk - sine * qk;
        a[q][k] = sine * pk + cosine * qk;
        double vp = v[k][p], vq = v[k][q];
        v[k][p] = cosine * vp - sine * vq;
        v[k][q] = sine * vp + cosine * vq;
    }
}

struct principal_axes covariance_axes(const struct covariance *c) {
    double a[3][3] = {{c->xx, c->xy, c->xz}, {c->xy, c->yy, c->yz}, {c->xz, c->yz, c->zz}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++) /* three to sort: two rounds of swaps, ties stay */
        for (int k = 0; k < 2; k++)
            if (a[order[k]][order[k]] > a[order[k + 1]][order[k + 1]]) {
                int other = order[k];
                order[k] = order[k + 1];
                order[k + 1] = other;
            }
    struct principal_axes axes = {.longest = {v[0][order[2]], v[1][order[2]], v[2][order[2]]}};
    for (int i = 0; i < 3; i++) axes.variance[i] = fmax(a[order[i]][order[i]], 0);
    return axes;
}
