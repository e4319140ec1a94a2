// Hits so near the ray's origin that the rounding of a float test says nothing about them.
//
// A ray leaves a surface from beyond the rounding error of its own position (core/rounding.h), and its queue names the
// triangle that it left. Near a corner the next wall may be no farther off than that. So what a float test cannot tell
// apart is decided by the plane through the corners in double, whose rounding is 2^29 times finer than the positions it
// judges: there is no distance below which a surface is not seen, and none at which a surface is met that lies behind.
#ifndef WAVELOBE_SHAPES_NEAR_PLANE_H
#define WAVELOBE_SHAPES_NEAR_PLANE_H

#pragma OPENCL EXTENSION cl_khr_fp64 : enable

#include "core/rounding.h"

typedef struct {
    float x, y, z;
} Point;

// Along a ray that lies nearly in the plane, which side of it the ray leaves to is itself a matter of rounding: the
// normal's three products, its length and the dot product with the direction make fewer than 10 roundings, each relative
// to the products that the normal's components are differences of.
#define PARALLEL_WITHIN ((double)GAMMA(10))

// Distance along the ray to the plane of the triangle; 0 if the plane is behind the origin, holds it, or is parallel.
INLINE float distance_to_plane(Point a, Point b, Point c, float ox, float oy, float oz, float dx, float dy, float dz) {
    double ux = (double)b.x - a.x, uy = (double)b.y - a.y, uz = (double)b.z - a.z;
    double vx = (double)c.x - a.x, vy = (double)c.y - a.y, vz = (double)c.z - a.z;
    double yz = uy * vz, zy = uz * vy, zx = uz * vx, xz = ux * vz, xy = ux * vy, yx = uy * vx;
    double nx = yz - zy, ny = zx - xz, nz = xy - yx;
    double along = nx * dx + ny * dy + nz * dz;
    double rounding = (fabs(yz) + fabs(zy)) * fabs((double)dx) + (fabs(zx) + fabs(xz)) * fabs((double)dy) +
                      (fabs(xy) + fabs(yx)) * fabs((double)dz);
    double height = nx * ((double)a.x - ox) + ny * ((double)a.y - oy) + nz * ((double)a.z - oz);
    float t = (float)(height / along);
    return ((fabs(along) > PARALLEL_WITHIN * rounding) & (t > 0.0f)) ? t : 0.0f;
}

#endif
