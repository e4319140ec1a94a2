// The principled materials of Mitsuba 3, after Burley 2012 and 2015.
#pragma once

#include "scene/texture.h"

namespace wavelobe {

// What the solid and the thin material share; each from 0 to 1.
struct PrincipledSurface {
    Parameter base_color{Rgb{0.5F}, nullptr};
    Parameter roughness{Rgb{0.5F}, nullptr};  // square root of the microfacets' alpha
    Parameter anisotropic{};
    Parameter spec_trans{};  // share that refracts
    Parameter spec_tint{};
    Parameter sheen{};
    Parameter sheen_tint{};
    Parameter flatness{};
};

struct Principled {
    PrincipledSurface surface;
    float eta = 1.5F;          // interior index over exterior index
    bool transmissive = false; // some of it refracts somewhere
    Parameter metallic{};
    Parameter clearcoat{};
    Parameter clearcoat_gloss{};
};

struct PrincipledThin {
    PrincipledSurface surface;
    Parameter eta{Rgb{1.5F}, nullptr};
    Parameter diff_trans{};  // 0 to 2: twice the share of diffuse light that goes through
};

}  // namespace wavelobe
