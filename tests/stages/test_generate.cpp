#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

class Generate : public StageTest {};

// A film of 40 x 24 pixels: its last tile has 8 x 8 pixels inside.
Scene film_scene() {
    Scene scene = empty_scene(1);
    scene.film.width = scene.film.crop_width = 40;
    scene.film.height = scene.film.crop_height = 24;
    look_at(scene, {1, 2, 3}, {2, 2.5F, -4}, {0, 1, 0}, 50.0F);
    scene.camera.near_clip = 0.25F;
    scene.camera.far_clip = 100.0F;
    return scene;
}

// Film coordinates in pixels that a camera ray passes through.
glm::dvec2 film_position(const Scene& scene, const glm::vec3& direction) {
    const glm::dvec3 d = glm::inverse(glm::dmat3(scene.camera.to_world)) * glm::dvec3(direction);
    const double half_width = std::tan(glm::radians(0.5 * static_cast<double>(scene.camera.fov_x_degrees)));
    const double pixel_size = 2.0 * half_width / scene.film.width;
    return {0.5 * scene.film.width - d.x / d.z / pixel_size, 0.5 * scene.film.height - d.y / d.z / pixel_size};
}

TEST_P(Generate, StartsThePathsInsideTheWindow) {
    const Scene scene = film_scene();
    StageBench bench(scene, GetParam(), 1024);
    bench.header().tile_x = 32;
    bench.header().tile_y = 16;
    bench.header().path_count = 2 * TILE_PIXELS;
    bench.header().next_path = 0;
    bench.run("generate");
    EXPECT_EQ(bench.header().next_path, 2 * TILE_PIXELS);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t n = 0; n < 2 * TILE_PIXELS; ++n) {
        const std::uint32_t pixel = n / 2;
        if (TILE_X(pixel) < 8 && TILE_Y(pixel) < 8) expected.push_back(n);
    }
    EXPECT_EQ(expected.size(), 2U * 64U);
    EXPECT_EQ(bench.ids(QUEUE_RAYS), expected);
}

TEST_P(Generate, RaysPassThroughTheirPixels) {
    for (const std::uint32_t samples : {2U, 3U}) {
        const Scene scene = film_scene();
        StageBench bench(scene, GetParam(), 1024);
        bench.header().tile_x = 16;
        bench.header().tile_y = 0;
        bench.header().path_count = samples * TILE_PIXELS;
        bench.header().next_path = 0;
        bench.run("generate");
        ASSERT_EQ(bench.header().count[QUEUE_RAYS], samples * TILE_PIXELS);
        const glm::dvec3 eye{scene.camera.to_world[3]};
        const glm::dvec3 forward{scene.camera.to_world[2]};
        for (std::uint32_t i = 0; i < bench.header().count[QUEUE_RAYS]; ++i) {
            const TestPath p = bench.path(QUEUE_RAYS, i);
            const glm::dvec2 at = film_position(scene, p.direction);
            const double rounding = 1e-4;  // of a pixel: a direction's rounding of 1e-7 over a pixel's angle of 0.02
            const std::uint32_t pixel = PATH_PIXEL(p.id, PATH_DIGITS(samples));
            ASSERT_GE(at.x, 16 + TILE_X(pixel) - rounding);
            ASSERT_LE(at.x, 17 + TILE_X(pixel) + rounding);
            ASSERT_GE(at.y, TILE_Y(pixel) - rounding);
            ASSERT_LE(at.y, TILE_Y(pixel) + 1 + rounding);
            ASSERT_NEAR(glm::length(glm::dvec3(p.direction)), 1.0, stage_rounding);
            // Planes of depth bound the ray.
            const double stretch = 1.0 / glm::dot(glm::dvec3(p.direction), forward);
            expect_close(p.origin, eye + glm::dvec3(p.direction) * stretch * 0.25);
            ASSERT_NEAR(p.t, stretch * 99.75, 99.75 * stage_rounding);
            ASSERT_EQ(p.throughput, glm::vec3(1));
            ASSERT_LT(p.pdf, 0.0F);
            ASSERT_EQ(p.depth, 0U);
        }
    }
}

// Samples of a pixel differ, and are those of the sample's index, not of its place in the block.
TEST_P(Generate, SamplesDependOnPixelAndIndexAlone) {
    StageBench bench(film_scene(), GetParam(), 1024);
    const auto direction = [&](std::uint32_t first_sample, std::uint32_t id) {
        bench.header().first_sample = first_sample;
        bench.header().count[QUEUE_RAYS] = 0;
        bench.header().path_count = 2 * TILE_PIXELS;
        bench.header().next_path = 0;
        bench.run("generate");
        std::uint32_t i = 0;
        while (i < 2 * TILE_PIXELS && bench.path(QUEUE_RAYS, i).id != id) ++i;
        return bench.path(QUEUE_RAYS, i).direction;
    };
    const std::uint32_t pixel = 77;
    const glm::vec3 sample5 = direction(5, 2 * pixel);
    EXPECT_EQ(direction(4, 2 * pixel + 1), sample5);
    EXPECT_NE(direction(6, 2 * pixel), sample5);
}

TEST_P(Generate, FillsFreeSlotsAndKeepsTheOthers) {
    const int lanes = GetParam();
    StageBench bench(film_scene(), lanes, 64);
    std::vector<TestPath> waiting(10);
    for (std::uint32_t i = 0; i < waiting.size(); ++i) {
        waiting[i].id = 700 + i;
        waiting[i].throughput = glm::vec3(0.5F, 0.25F, static_cast<float>(i));
        waiting[i].depth = 3;
    }
    bench.fill(QUEUE_RAYS, waiting);
    bench.header().path_count = 4 * TILE_PIXELS;
    bench.header().next_path = 2 * TILE_PIXELS;
    bench.run("generate");
    // Whole groups, as many as fit.
    const auto started = static_cast<std::uint32_t>((64 - 10) / lanes * lanes);
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 10 + started);
    EXPECT_EQ(bench.header().next_path, 2 * TILE_PIXELS + started);
    for (std::uint32_t i = 0; i < 10; ++i) {
        EXPECT_EQ(bench.path(QUEUE_RAYS, i).id, 700 + i);
        EXPECT_EQ(bench.path(QUEUE_RAYS, i).throughput, waiting[i].throughput);
        EXPECT_EQ(bench.path(QUEUE_RAYS, i).depth, 3U);
    }
    for (std::uint32_t i = 0; i < started; ++i) EXPECT_EQ(bench.path(QUEUE_RAYS, 10 + i).id, 2 * TILE_PIXELS + i);
}

// Rays of one pixel are the most alike.
TEST(PathIds, NameEachSampleOnceAndThoseOfAPixelInARow) {
    for (std::uint32_t samples = 1; samples <= BLOCK_SAMPLES; ++samples) {
        const std::uint32_t digits = PATH_DIGITS(samples), together = samples & (0U - samples);
        EXPECT_EQ(1U << digits, together);
        std::vector<bool> seen(std::size_t{samples} * TILE_PIXELS);
        for (std::uint32_t id = 0; id < seen.size(); ++id) {
            const std::uint32_t pixel = PATH_PIXEL(id, digits), sample = PATH_SAMPLE(id, digits);
            ASSERT_EQ(ID_OF_PATH(pixel, sample, digits), id);
            ASSERT_EQ(pixel, id / together % TILE_PIXELS);
            ASSERT_LT(sample, samples);
            ASSERT_FALSE(seen[sample * TILE_PIXELS + pixel]);
            seen[sample * TILE_PIXELS + pixel] = true;
            const std::uint32_t before = id < together * TILE_PIXELS ? 0 : PATH_SAMPLE(id - together * TILE_PIXELS, digits) + 1;
            ASSERT_GE(sample, before) << "in order";
        }
    }
}

TEST_P(Generate, StartsEachPathOnceInTheOrderOfIds) {
    for (const std::uint32_t samples : {1U, 3U, 8U, 12U, 16U}) {
        StageBench bench(film_scene(), GetParam(), 1024);
        bench.header().path_count = samples * TILE_PIXELS;
        bench.header().next_path = 0;
        bench.run("generate");
        std::vector<std::uint32_t> expected(std::min<std::size_t>(1024, std::size_t{samples} * TILE_PIXELS));
        std::iota(expected.begin(), expected.end(), 0U);
        EXPECT_EQ(bench.ids(QUEUE_RAYS), expected) << samples << " samples";
    }
}

TEST_P(Generate, DoesNothingWhenAllAreStarted) {
    StageBench bench(film_scene(), GetParam());
    bench.run("generate");
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 0U);
    EXPECT_EQ(bench.header().next_path, TILE_PIXELS);
}

TEST_P(Generate, CropWindowKeepsFilmCoordinates) {
    Scene scene = film_scene();
    StageBench whole(scene, GetParam(), 1024);
    scene.film.crop_x = 16;
    scene.film.crop_width = 7;
    scene.film.crop_height = 5;
    StageBench crop(scene, GetParam(), 1024);
    for (StageBench* bench : {&whole, &crop}) {
        bench->header().tile_x = 16;
        bench->header().next_path = 0;
        bench->run("generate");
    }
    ASSERT_EQ(crop.header().count[QUEUE_RAYS], 35U);
    for (std::uint32_t i = 0; i < 35; ++i) {
        const TestPath p = crop.path(QUEUE_RAYS, i);
        EXPECT_EQ(whole.path(QUEUE_RAYS, p.id).direction, p.direction);
    }
}

// All rays are parallel, from a plane that the film spans: [-1, 1] of the transform's x axis.
TEST_P(Generate, OrthographicRaysAreParallel) {
    Scene scene = film_scene();
    scene.camera.projection = Camera::Projection::orthographic;
    scene.camera.to_world = scene.camera.to_world * glm::scale(glm::mat4(1.0F), {3, 3, 1});
    StageBench bench(scene, GetParam(), 1024);
    bench.header().tile_x = 16;
    bench.header().path_count = TILE_PIXELS;
    bench.header().next_path = 0;
    bench.run("generate");
    ASSERT_EQ(bench.header().count[QUEUE_RAYS], TILE_PIXELS);
    for (std::uint32_t i = 0; i < TILE_PIXELS; ++i) {
        const TestPath p = bench.path(QUEUE_RAYS, i);
        expect_close(p.direction, glm::dvec3(scene.camera.to_world[2]));
        ASSERT_NEAR(p.t, 99.75, 99.75 * stage_rounding);
        const glm::dvec3 local = glm::inverse(glm::dmat4(scene.camera.to_world)) * glm::dvec4(p.origin, 1);
        ASSERT_NEAR(local.z, 0.25, 1e-5);
        ASSERT_NEAR((1 - local.x) * 20, 16.5 + TILE_X(p.id), 0.5 + 1e-4);
        ASSERT_NEAR((24.0 / 40 - local.y) * 20, 0.5 + TILE_Y(p.id), 0.5 + 1e-4);
    }
}

// Rays of one place of the film start all over the lens and meet in the plane that is sharp.
TEST_P(Generate, RaysThroughALensMeetWhereItIsFocused) {
    Scene scene = film_scene();
    StageBench pinhole(scene, GetParam(), 1024);
    scene.camera.aperture_radius = 0.4F;
    scene.camera.focus_distance = 7.0F;
    StageBench lens(scene, GetParam(), 1024);
    for (StageBench* bench : {&pinhole, &lens}) {
        bench->header().tile_x = 16;
        bench->header().path_count = 4 * TILE_PIXELS;
        bench->header().next_path = 0;
        bench->run("generate");
    }
    const glm::dmat4 to_camera = glm::inverse(glm::dmat4(scene.camera.to_world));
    glm::dvec2 mean(0.0);
    double mean_square = 0.0;
    const std::uint32_t n = lens.header().count[QUEUE_RAYS];
    ASSERT_EQ(n, 4 * TILE_PIXELS);
    for (std::uint32_t i = 0; i < n; ++i) {
        const TestPath p = lens.path(QUEUE_RAYS, i), q = pinhole.path(QUEUE_RAYS, i);
        const auto at_depth = [&](const TestPath& path, double depth) {
            const glm::dvec3 origin = to_camera * glm::dvec4(path.origin, 1), d = glm::dmat3(to_camera) * glm::dvec3(path.direction);
            return origin + d * ((depth - origin.z) / d.z);
        };
        ASSERT_LT(glm::distance(at_depth(p, 7.0), at_depth(q, 7.0)), 2e-5) << "the same sharp point";
        const glm::dvec2 on_lens = at_depth(p, 0.0);
        ASSERT_LE(glm::length(on_lens), 0.4 + 1e-5);
        mean += on_lens / static_cast<double>(n);
        mean_square += glm::dot(on_lens, on_lens) / n;
        ASSERT_NEAR((to_camera * glm::dvec4(p.origin, 1)).z, 0.25, 1e-5);
        const double cosine = (glm::dmat3(to_camera) * glm::dvec3(p.direction)).z;
        ASSERT_NEAR(p.t * cosine, 99.75, 1e-3);
    }
    EXPECT_LT(glm::length(mean), 0.01);
    EXPECT_NEAR(mean_square, 0.5 * 0.16, 0.003) << "even over the disk";
}

WAVELOBE_AT_EACH_WIDTH(Generate);

}  // namespace
}  // namespace wavelobe::test
