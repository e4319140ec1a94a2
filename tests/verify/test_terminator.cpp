// Shading normals that differ from the geometry: what a coarse ball with vertex normals does to the energy of even light.
//
// As in Mitsuba 3 the side of a surface and the cosines are those of the shading frame, and nothing is scaled: directions between
// the two horizons go into the ball. What is twosided scatters them on until they come out again, so that a white ball loses
// and gains nothing; what is black inside loses them.
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

RoughConductor white_metal(float alpha) { return {Rgb{0.0F}, Rgb{1.0F}, constant(1.0F), constant(alpha), constant(alpha), Distribution::ggx}; }

TEST(Terminator, WhiteBallsKeepTheirEnergy) {
    for (const auto& [levels, bumps] : {std::pair{1, 0.0F}, {2, 0.0F}, {2, 0.4F}}) {
        const Scene scene = ball(levels, bumps, Diffuse{constant(1.0F)}, true);
        Claim claim("Numerical stability",
                    fmt::format("White ball of {} triangles, smooth normals{}, in even light: gain or loss", 8 << (2 * levels),
                                bumps > 0.0F ? " that are bumpy" : ""),
                    "standard errors");
        const Rendering rendering = render(scene, quick_or_full(64, 1024));
        const PictureMean found = picture_mean(rendering.image);
        claim.observe(std::abs(found.mean.x - 1.0) / found.standard_error.x,
                      [&] { return fmt::format("mean {:.5f}, standard error {:.5f}", found.mean.x, found.standard_error.x); });
        claim.count(rendering.stats.samples);
        claim.at_most(4.0);
        EXPECT_LT(found.standard_error.x, 0.005);
    }
}

// What the black inside takes, and none gains.
TEST(Terminator, MetalLosesWhatGoesInside) {
    std::vector<std::vector<nlohmann::json>> rows;
    Claim claim("Numerical stability", "Rough white metal on coarse balls with smooth normals: gain", "relative");
    for (const int levels : {1, 2, 3}) {
        for (const float alpha : {0.05F, 0.3F}) {
            const PictureMean smooth = picture_mean(render(ball(levels, 0.0F, white_metal(alpha), false), quick_or_full(32, 512)).image);
            claim.observe(smooth.mean.x - 1.0 - 4.0 * smooth.standard_error.x);
            rows.push_back({8 << (2 * levels), alpha, smooth.mean.x, smooth.standard_error.x});
            EXPECT_GT(smooth.mean.x, 0.7);
        }
    }
    claim.at_most(0.0);
    write_report_table("Numerical stability", "Energy of white rough metal (black inside) on balls with smooth normals in even light; Mitsuba 3 makes the same",
                       {"triangles", "alpha", "mean", "standard error"}, rows);
}

}  // namespace
}  // namespace wavelobe::test
