// What the lights with an analytic shape share.
#ifndef WAVELOBE_LIGHTS_ANALYTIC_H
#define WAVELOBE_LIGHTS_ANALYTIC_H

#include "lights/area.h"
#include "shapes/analytic_geometry.h"

INLINE AnalyticMap light_analytic_map(LightInput in) {
    return analytic_map(in.analytics, as_UInt(light_field(in, analytic)));
}

// The sample at `object` on a unit disk or cylinder, where the unit normal is `g`.
INLINE LightSample analytic_light_sample(LightInput in, Vec3 reference, Vec3 object, Vec3 g) {
    AnalyticMap m = light_analytic_map(in);
    AnalyticPoint p = analytic_point(m, object, g);
    Float u = ZERO, v = ZERO;
#if HAS_TEXTURED_EMITTERS
    analytic_uv(m.kind, object, &u, &v);
#endif
    return area_light_sample(in, reference, p.position, p.error, p.normal, u, v, ZERO);
}

#endif
