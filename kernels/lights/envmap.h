// A latitude-longitude picture at infinity.  Uses the environment record and its tables.
//
// Where the picture is, as Mitsuba 3 has it: in the environment's own space a direction has u = atan2(x, -z) / (2 pi) and
// v = acos(y) / pi.  Columns are centred, texel k at u = (k + 1/2) / width, and wrap around; rows reach from pole to pole,
// texel j at v = j / (height - 1), so that the first row is the upper pole and the last the lower one.
//
// A cell is the square between four neighbouring texels: `width` columns, from the first texel's centre on, by
// `height - 1` rows.  The running sums hold those of each row's cells, row by row, and after these those of the rows: with
// a random number each for row and column a large picture leaves both enough digits for the place inside the cell.
// `environment_density` is the density in (u, v), constant inside each cell.
#ifndef WAVELOBE_LIGHTS_ENVMAP_H
#define WAVELOBE_LIGHTS_ENVMAP_H

#include "lights/infinite.h"
#include "lights/step_pick.h"

// A place on the picture: its cell, and where inside it.
typedef struct {
    UInt row, column;
    Float row_fraction, column_fraction;
    Float sine; // of the angle from the pole
} EnvironmentPlace;

// The density over solid angle grows without bound towards the poles. Below this sine it stays what it is there, so that
// it and its square are finite for as many as 2^31 cells.
#define LEAST_POLE_SINE 0x1p-36f

INLINE Vec3 environment_turn(global const float *m, Vec3 d) {
    return vec3(madd(d.x, (Float)m[0], madd(d.y, (Float)m[1], d.z * m[2])),
                madd(d.x, (Float)m[4], madd(d.y, (Float)m[5], d.z * m[6])),
                madd(d.x, (Float)m[8], madd(d.y, (Float)m[9], d.z * m[10])));
}

INLINE EnvironmentPlace environment_place(LightInput in, Vec3 direction) {
    global const struct Environment *e = in.environment;
    Vec3 d = environment_turn(e->to_object.m, direction);
    Float columns = (Float)(float)e->cell_columns, rows = (Float)(float)e->cell_rows;
    Float turns = lane_atan2(d.x, -d.z) * INV_TWO_PI_F;
    Float x = madd(SELECT(turns < 0.0f, turns + 1.0f, turns), columns, (Float)-0.5f);
    // What is no direction, in lanes that hold no path, gets the last column and row: LESSER of what is no number is the bound.
    Float column = LESSER(floor(x), columns - 1.0f);
    // From the distance to the axis, not from the cosine, which hardly changes near the poles.
    Float axis_distance = sqrt(madd(d.x, d.x, d.z * d.z));
    Float y = lane_atan2(axis_distance, d.y) * INV_PI * rows;
    Float row = LESSER(floor(y), rows - 1.0f);
    EnvironmentPlace p;
    p.column = as_UInt(convert_Int(SELECT(column < 0.0f, columns - 1.0f, column)));
    p.row = as_UInt(convert_Int(row));
    p.column_fraction = x - column;
    p.row_fraction = y - row;
    p.sine = axis_distance / sqrt(length_squared(d));
    return p;
}

INLINE Rgb environment_texel(LightInput in, UInt row, UInt column) {
    UInt i = (row * in.environment->width + column) * 3u;
    return vec3(gather(in.environment_texels, i), gather(in.environment_texels + 1, i), gather(in.environment_texels + 2, i));
}

// Linear between two colours.
INLINE Rgb environment_between(Rgb a, Rgb b, Float t) { return scale_add(b, t, scale(a, 1.0f - t)); }

INLINE Rgb environment_radiance(LightInput in, EnvironmentPlace p) {
    UInt next = p.column + 1u;
    next = SELECT(next == (UInt)in.environment->width, (UInt)0u, next);
    Rgb upper = environment_between(environment_texel(in, p.row, p.column), environment_texel(in, p.row, next), p.column_fraction);
    Rgb lower = environment_between(environment_texel(in, p.row + 1u, p.column), environment_texel(in, p.row + 1u, next),
                                    p.column_fraction);
    global const struct Packed3 *scale_rgb = &in.environment->radiance;
    return mul(environment_between(upper, lower, p.row_fraction),
               vec3((Float)scale_rgb->x, (Float)scale_rgb->y, (Float)scale_rgb->z));
}

// du dv = sin(theta)^-1 / (2 pi^2) domega
INLINE Float environment_pdf(LightInput in, EnvironmentPlace p) {
    Float density = gather(in.environment_density, p.row * in.environment->cell_columns + p.column);
    return density * (INV_TWO_PI_F * INV_PI) / GREATER(p.sine, (Float)LEAST_POLE_SINE);
}

INLINE Rgb envmap_radiance(LightInput in, Vec3 direction) {
    return environment_radiance(in, environment_place(in, direction));
}

INLINE Float envmap_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    return environment_pdf(in, environment_place(in, direction));
}

INLINE LightSample envmap_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    global const struct Environment *e = in.environment;
    uint columns = e->cell_columns, rows = e->cell_rows;
    StepPick row = step_pick(in.environment_sums, (UInt)((columns + 1u) * rows), rows, u2);
    StepPick column = step_pick(in.environment_sums, row.index * (columns + 1u), columns, u1);
    EnvironmentPlace p;
    p.row = row.index, p.column = column.index;
    p.row_fraction = row.fraction, p.column_fraction = column.fraction;

    // The polar angle, in half turns, counted from the nearer pole so that its sine keeps its digits.
    Float j = convert_Float(as_Int(p.row)), last = (Float)((float)rows - 1.0f);
    Int upper = 2.0f * j < last;
    Float from_pole = SELECT(upper, j + p.row_fraction, (last - j) + (1.0f - p.row_fraction)) / (float)rows;
    Float sin_theta, cos_theta, sin_phi, cos_phi;
    lane_sin_cos_turns(0.5f * from_pole, &sin_theta, &cos_theta);
    Float u = (convert_Float(as_Int(p.column)) + p.column_fraction + 0.5f) / (float)columns;
    lane_sin_cos_turns(SELECT(u < 1.0f, u, u - 1.0f), &sin_phi, &cos_phi);
    p.sine = sin_theta;
    Vec3 object = vec3(sin_phi * sin_theta, SELECT(upper, cos_theta, -cos_theta), -cos_phi * sin_theta);
    Vec3 direction = normalize3(environment_turn(e->to_world.m, object));
    return infinite_light_sample(direction, environment_radiance(in, p), environment_pdf(in, p), !TRUE_MASK);
}

#endif
