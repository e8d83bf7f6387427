/* The principal axes of points in space. Pure. */
#ifndef SCREE_LOD_COVARIANCE_H
#define SCREE_LOD_COVARIANCE_H

#include "stream/ellipsoid.h"

/* Sums of the products of coordinates about the mean: a symmetric matrix. */
struct covariance {
    double xx, xy, xz, yy, yz, zz;
};

struct principal_axes {
    double variance[3];     /* of the directions below, rising; at least 0 */
    struct vector3 longest; /* the unit vector of the largest variance */
};

/* Jacobi's rotations (Golub and Van Loan, "Matrix Computations", section 8.5): additions, multiplications, divisions
 * and square roots only, so the same bits everywhere. */
struct principal_axes covariance_axes(const struct covariance *covariance);

#endif
