// The watertight triangle test on vectors of one width: neighbours that share an edge leave no gap for a ray to slip through.
// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".
//
// A template: shapes/triangle_block.h includes it for eight triangles against a ray, shapes/packet.h for a ray a lane against a
// triangle. One pair of ray and triangle gives the same bits in both. Wants
//   TEST_VALUES, TEST_MASK   a vector of floats and what its comparisons give
//   TEST(name)               the name of this width's copy

// Corners relative to the origin, axes permuted so that the ray's largest is z; then sheared so that the ray is z.
typedef struct {
    TEST_VALUES ax, ay, az, bx, by, bz, cx, cy, cz;
    TEST_VALUES wa, wb, wc, sum; // areas opposite to the corners, twice, with the sign of the side
} TEST(Sheared);

INLINE TEST_VALUES TEST(fused)(TEST_VALUES a, TEST_VALUES b, TEST_VALUES c) {
#pragma OPENCL FP_CONTRACT ON
    return a * b + c;
}

// Shears the corners, and says where the ray's line meets the triangle.
INLINE TEST_MASK TEST(shear)(TEST(Sheared) *t, TEST_VALUES shear_x, TEST_VALUES shear_y) {
    TEST_VALUES sx = -shear_x, sy = -shear_y;
    t->ax = TEST(fused)(sx, t->az, t->ax), t->ay = TEST(fused)(sy, t->az, t->ay);
    t->bx = TEST(fused)(sx, t->bz, t->bx), t->by = TEST(fused)(sy, t->bz, t->by);
    t->cx = TEST(fused)(sx, t->cz, t->cx), t->cy = TEST(fused)(sy, t->cz, t->cy);
    // The products are rounded one by one so that both triangles at an edge compute the same value for it up to its sign.
    t->wa = t->cx * t->by - t->cy * t->bx;
    t->wb = t->ax * t->cy - t->ay * t->cx;
    t->wc = t->bx * t->ay - t->by * t->ax;
    t->sum = t->wa + t->wb + t->wc;
    TEST_VALUES least = LESSER(LESSER(t->wa, t->wb), t->wc), most = GREATER(GREATER(t->wa, t->wb), t->wc);
    return ((least >= 0.0f) | (most <= 0.0f)) & (t->sum != 0.0f);
}

// The distance times `sum`.
INLINE TEST_VALUES TEST(depth)(const TEST(Sheared) *t, TEST_VALUES shear_z) {
    return shear_z * TEST(fused)(t->wa, t->az, TEST(fused)(t->wb, t->bz, t->wc * t->cz));
}

// The depth is off by less than this times p q^2, where p is the largest coordinate across the ray and q the largest of
// all: coordinates are off by at most GAMMA(10) q, areas of at most 2 p^2 by 44 HALF_ULP p q, and three products of one and
// the other by 168 HALF_ULP p q^2. (After Pharr, Jakob, Humphreys, "Physically Based Rendering", "Managing Rounding Error",
// bounding triangle intersections.)
#define DISTANCE_ERROR GAMMA(180)

INLINE TEST_VALUES TEST(largest)(TEST_VALUES a, TEST_VALUES b, TEST_VALUES c) {
    return GREATER(GREATER(fabs(a), fabs(b)), fabs(c));
}

// Where the depth is too small to say on which side of the origin the triangle lies.
INLINE TEST_MASK TEST(unsure)(const TEST(Sheared) *t, TEST_VALUES depth, TEST_VALUES shear_z) {
    TEST_VALUES across = GREATER(TEST(largest)(t->ax, t->bx, t->cx), TEST(largest)(t->ay, t->by, t->cy));
    TEST_VALUES size = GREATER(across, TEST(largest)(t->az, t->bz, t->cz) * fabs(shear_z));
    return fabs(depth) <= DISTANCE_ERROR * across * size * size;
}
