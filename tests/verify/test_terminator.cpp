// Shading normals that differ from the geometry: what a coarse ball with vertex normals does to the energy of even light.
//
// As in Mitsuba 3 the side of a surface and the cosines are those of the shading frame, and nothing is scaled: directions between
// the two horizons go into the ball. What is twosided scatters them on until they come out again, so that a white ball loses
// and gains nothing; what is black inside loses them.
#include <algorithm>

#include "support/many_features.h"
#include "support/render.h"
#include "support/triangle_meshes.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

// `bumps`: by how much of their length the normals of the vertices are turned at random.
Scene ball(int levels, float bumps, MaterialModel model, bool twosided) {
    Scene scene = empty_scene(64);
    scene.integrator.rr_depth = 1000;
    look_at(scene, {1, 2, 6}, {0, 0, 0}, {0, 1, 0}, 12.0F); // within the silhouette
    const ClosedMesh sphere = sphere_mesh(levels, 1.0F, {0, 0, 0});
    TriangleMesh mesh;
    mesh.positions = sphere.vertices;
    mesh.triangles = sphere.faces;
    Generator random(1);
    for (const glm::vec3& p : sphere.vertices) mesh.normals.push_back(glm::normalize(glm::normalize(p) + bumps * uniform_direction(random)));
    Shape& shape = add_shape(scene, std::move(mesh), add_material(scene, std::move(model)), "ball");
    if (twosided) shape.material.back = shape.material.front;
    scene.emitters.emplace_back(ConstantEmitter{Rgb{1.0F}});
    return scene;
}

Rendering render_ball(const Scene& scene, int samples_per_pixel, bool smooth_terminator) {
    RenderSettings settings;
    settings.samples_per_pixel = samples_per_pixel;
    settings.smooth_terminator = smooth_terminator;
    return render(scene, settings);
}

RoughConductor white_metal(float alpha) { return {Rgb{0.0F}, Rgb{1.0F}, constant(1.0F), constant(alpha), constant(alpha), Distribution::ggx}; }

TEST(Terminator, WhiteBallsKeepTheirEnergy) {
    for (const auto& [levels, bumps] : {std::pair{1, 0.0F}, {2, 0.0F}, {2, 0.4F}}) {
        const Scene scene = ball(levels, bumps, Diffuse{constant(1.0F)}, true);
        for (const bool smooth_terminator : {false, true}) {
            Claim claim("Numerical stability",
                        fmt::format("White ball of {} triangles, smooth normals{}, in even light{}: gain or loss", 8 << (2 * levels),
                                    bumps > 0.0F ? " that are bumpy" : "", smooth_terminator ? ", smooth terminator" : ""),
                        "standard errors");
            const Rendering rendering = render_ball(scene, quick_or_full(64, 1024), smooth_terminator);
            const PictureMean found = picture_mean(rendering.image);
            claim.observe(std::abs(found.mean.x - 1.0) / found.standard_error.x,
                          [&] { return fmt::format("mean {:.5f}, standard error {:.5f}", found.mean.x, found.standard_error.x); });
            claim.count(rendering.stats.samples);
            claim.at_most(4.0);
            EXPECT_LT(found.standard_error.x, 0.005);
        }
    }
}

// What the black inside takes, and none gains.
TEST(Terminator, MetalLosesWhatGoesInside) {
    std::vector<std::vector<ReportCell>> rows;
    Claim claim("Numerical stability", "Rough white metal on coarse balls with smooth normals: gain", "relative");
    for (const int levels : {1, 2, 3}) {
        for (const float alpha : {0.05F, 0.3F}) {
            const Scene scene = ball(levels, 0.0F, white_metal(alpha), false);
            const auto mean_of = [&](bool smooth_terminator) {
                const PictureMean found = picture_mean(render_ball(scene, quick_or_full(32, 512), smooth_terminator).image);
                claim.observe(found.mean.x - 1.0 - 4.0 * found.standard_error.x);
                EXPECT_LT(found.standard_error.x, 0.005);
                return found.mean.x;
            };
            const double facets = mean_of(false), smooth = mean_of(true);
            rows.push_back({8 << (2 * levels), static_cast<double>(alpha), facets, smooth});
            EXPECT_GT(facets, 0.7);
            EXPECT_GT(smooth, facets);
        }
    }
    claim.at_most(0.0);
    write_report_table("Numerical stability", "Energy of white rough metal (black inside) on balls with smooth normals in even light; Mitsuba 3 makes the former",
                       {"triangles", "alpha", "as the facets are", "with --smooth-terminator"}, rows);
}

// Lit from the side, so that the terminator runs down the middle.
Image side_lit(int levels, bool smooth_terminator) {
    Scene scene = ball(levels, 0.0F, Diffuse{constant(0.8F)}, false);
    scene.emitters = {Emitter{DirectionalEmitter{{-2, 1, -0.5F}, Rgb{3.0F}}}};
    return render_ball(scene, 16, smooth_terminator).image;
}

// Of the pixels in which a round ball is lit, the share that is less than half as bright as there.
double share_of_dark(const Image& image, const Image& round) {
    const float lit = 0.05F * *std::max_element(round.rgb.begin(), round.rgb.end());
    double dark = 0.0, all = 0.0;
    for (std::size_t i = 0; i < round.rgb.size(); i += 3) {
        if (round.rgb[i] < lit) continue;
        all += 1.0;
        if (image.rgb[i] < 0.5F * round.rgb[i]) dark += 1.0;
    }
    return dark / all;
}

TEST(Terminator, CoarseBallsAreLitLikeRoundOnes) {
    const Image round = side_lit(7, false);
    std::vector<std::vector<ReportCell>> rows;
    Claim claim("Numerical stability", "Coarse balls lit from the side, smooth terminator: less than half as bright as a round one", "of its lit pixels");
    for (const int levels : {2, 3}) {
        const double facets = share_of_dark(side_lit(levels, false), round), smooth = share_of_dark(side_lit(levels, true), round);
        claim.observe(smooth, [&] { return fmt::format("{} triangles", 8 << (2 * levels)); });
        rows.push_back({8 << (2 * levels), facets, smooth});
        EXPECT_GT(facets, 0.01);
    }
    claim.at_most(0.001);
    write_report_table("Numerical stability", "Where coarse balls with smooth normals, lit from the side, are less than half as bright as a round one",
                       {"triangles", "as the facets are", "with --smooth-terminator"}, rows);
}

TEST(Terminator, IsSmoothBesideEverythingElse) {
    RenderSettings settings;
    settings.samples_per_pixel = 4;
    settings.smooth_terminator = true;
    const std::vector<std::string> features = render(many_features_scene(33, 21), settings).stats.features;
    EXPECT_NE(std::find(features.begin(), features.end(), "smooth_terminator"), features.end());
}

}  // namespace
}  // namespace wavelobe::test
