// What dielectric surfaces do to diffuse light.
#include <gtest/gtest.h>

#include "tables/dielectric_surface.h"

namespace wavelobe {
namespace {

// Egan, Hilgeman 1979, "Optical Properties of Inhomogeneous Materials": a rational fit, good to 2e-3 here.
TEST(DielectricSurface, DiffuseReflectance) {
    for (const double eta : {1.3, 1.5, 1.9}) {
        const double external = diffuse_fresnel(eta);
        const double internal = diffuse_fresnel(1.0 / eta);
        // Reciprocity: what gets in and out of a hemisphere is the same, by the squared index.
        EXPECT_NEAR(1.0 - internal, (1.0 - external) / (eta * eta), 1e-5) << eta;
        EXPECT_NEAR(internal, -1.4399 / (eta * eta) + 0.7099 / eta + 0.6681 + 0.0636 * eta, 5e-3) << eta;
    }
    EXPECT_EQ(diffuse_fresnel(1.0), 0.0);
}

// A surface that is almost smooth does what a smooth one does.
TEST(DielectricSurface, SmoothLimit) {
    for (const Distribution d : {Distribution::ggx, Distribution::beckmann}) {
        const RoughSurface surface = rough_surface(1.5, 1e-3, d);
        EXPECT_NEAR(surface.transmittance.back(), 0.96F, 1e-3F);
        // At 30 steps of 63 from grazing: Fresnel by hand for cos 0.47619, eta 1.5.
        EXPECT_NEAR(surface.transmittance[30], 0.9014F, 2e-3F);
        EXPECT_LT(surface.transmittance[0], 0.1F);
        EXPECT_NEAR(surface.internal_reflectance, diffuse_fresnel(1.0 / 1.5), 1e-2);
    }
}

// Light is lost between the microfacets of rough surfaces, more so by the long tails of GGX; in Mitsuba's model, too.
TEST(DielectricSurface, RoughSurfacesLoseLight) {
    for (const Distribution d : {Distribution::ggx, Distribution::beckmann}) {
        const RoughSurface smooth = rough_surface(1.5, 0.05, d);
        const RoughSurface rough = rough_surface(1.5, 0.8, d);
        EXPECT_LT(rough.transmittance.back(), smooth.transmittance.back());
        EXPECT_LT(rough.internal_reflectance, 0.7F * smooth.internal_reflectance);
        for (std::size_t i = 0; i < ROUGH_TRANSMITTANCE_STEPS; ++i) {
            EXPECT_GT(rough.transmittance[i], 0.0F) << i;
            EXPECT_LE(rough.transmittance[i], 1.0F) << i;
        }
    }
    // Mitsuba 3.9.1, evaluated at alpha 0.3 and the default indices.
    const RoughSurface ggx = rough_surface(1.49 / 1.000277, 0.3, Distribution::ggx);
    EXPECT_NEAR(ggx.transmittance[5], 0.7012F, 2e-3F);
    EXPECT_NEAR(ggx.transmittance[20], 0.8263F, 2e-3F);
    EXPECT_NEAR(ggx.transmittance[40], 0.9177F, 2e-3F);
    EXPECT_NEAR(ggx.transmittance[63], 0.9545F, 2e-3F);
    EXPECT_NEAR(ggx.internal_reflectance, 0.4088F, 2e-3F);
}

}  // namespace
}  // namespace wavelobe
