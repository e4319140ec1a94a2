#include <gtest/gtest.h>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

class Accumulate : public StageTest {
protected:
    // A film of 20 x 18 pixels; the tile at (16, 16) has 4 x 2 of them.
    static Scene film_scene() {
        Scene scene = empty_scene(1);
        scene.film.width = scene.film.crop_width = 20;
        scene.film.height = scene.film.crop_height = 18;
        add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
        scene.emitters.emplace_back(PointEmitter{});
        return scene;
    }

    static float value(std::uint32_t id, std::uint32_t channel) {
        return 0.1F * static_cast<float>(id + 1) + 1000.0F * static_cast<float>(channel);
    }

    static void fill_radiance(StageBench& bench, std::uint32_t count) {
        bench.header().path_count = count;
        bench.header().next_path = count;
        for (std::uint32_t id = 0; id < count; ++id) {
            for (std::uint32_t c = 0; c < 3; ++c) bench.radiance(id, c) = value(id, c);
        }
    }
};

TEST_P(Accumulate, AddsSamplesInOrder) {
    StageBench bench(film_scene(), GetParam());
    fill_radiance(bench, 3 * TILE_PIXELS);
    const FilmPixel before{{1e9, 2.0, 3.0}, 7, 1};
    for (FilmPixel& pixel : bench.film()) pixel = before;
    bench.run("accumulate");
    EXPECT_EQ(bench.header().path_count, 0U) << "the block is free";
    EXPECT_EQ(bench.header().nonfinite_path, WAVELOBE_NONE);
    for (std::uint32_t y = 0; y < 18; ++y) {
        for (std::uint32_t x = 0; x < 20; ++x) {
            const FilmPixel& pixel = bench.film()[y * 20 + x];
            FilmPixel expected = before;
            if (x < 16 && y < 16) {
                std::uint32_t id = 0;
                while (TILE_X(id) != x || TILE_Y(id) != y) ++id;
                for (std::uint32_t sample = 0; sample < 3; ++sample) {
                    for (std::uint32_t c = 0; c < 3; ++c)
                        expected.sum[c] += static_cast<double>(value(ID_OF_PATH(id, sample, PATH_DIGITS(3U)), c));
                }
                expected.samples += 3;
            }
            for (int c = 0; c < 3; ++c) ASSERT_EQ(pixel.sum[c], expected.sum[c]) << x << ", " << y;
            ASSERT_EQ(pixel.samples, expected.samples);
            ASSERT_EQ(pixel.nonfinite, 1U);
        }
    }
    for (std::uint32_t id = 0; id < 3 * TILE_PIXELS; ++id)
        ASSERT_EQ(bench.radiance(id), glm::vec3(0)) << "cleared for the next tile";
}

TEST_P(Accumulate, LeavesOutWhatLiesBeyondTheWindow) {
    StageBench bench(film_scene(), GetParam());
    bench.header().tile_x = 16;
    bench.header().tile_y = 16;
    fill_radiance(bench, TILE_PIXELS);
    bench.run("accumulate");
    std::uint32_t samples = 0;
    for (const FilmPixel& pixel : bench.film()) samples += pixel.samples;
    EXPECT_EQ(samples, 4U * 2U);
    const FilmPixel& corner = bench.film()[17 * 20 + 19];
    EXPECT_EQ(corner.samples, 1U);
    EXPECT_EQ(corner.sum[0], static_cast<double>(value(4 + 3, 0))) << "x = 3, y = 1 of the tile is id 7";
}

TEST_P(Accumulate, CountsWhatIsNotFinite) {
    StageBench bench(film_scene(), GetParam());
    fill_radiance(bench, 2 * TILE_PIXELS);
    bench.radiance(10, 1) = std::numeric_limits<float>::quiet_NaN();
    bench.radiance(13, 2) = std::numeric_limits<float>::infinity();
    bench.radiance(14, 0) = bench.radiance(15, 0) = -std::numeric_limits<float>::infinity();
    bench.run("accumulate");
    // Pixels 4 to 7 are the second row's first four; ids 8 to 15 are their two samples each.
    const auto pixel = [&](std::uint32_t x) { return bench.film()[20 + x]; };
    EXPECT_EQ(pixel(0).samples, 2U);
    EXPECT_EQ(pixel(1).samples, 1U);
    EXPECT_EQ(pixel(1).nonfinite, 1U);
    EXPECT_EQ(pixel(1).sum[1], static_cast<double>(value(11, 1)));
    EXPECT_EQ(pixel(2).samples, 1U);
    EXPECT_EQ(pixel(2).sum[2], static_cast<double>(value(12, 2)));
    EXPECT_EQ(pixel(3).samples, 0U);
    EXPECT_EQ(pixel(3).nonfinite, 2U);
    EXPECT_EQ(pixel(3).sum[0], 0.0);
    EXPECT_EQ(bench.header().nonfinite_path / 2, 7U) << "one of them is named";
}

TEST_P(Accumulate, WaitsForPathsThatAreUnderWay) {
    for (int i = 0; i < 3; ++i) {
        StageBench bench(film_scene(), GetParam());
        fill_radiance(bench, TILE_PIXELS);
        if (i == 0) bench.header().next_path = TILE_PIXELS - 16;
        if (i == 1) bench.header().count[QUEUE_RAYS] = 1;
        if (i == 2) bench.header().count[QUEUE_SHADOW] = 1;
        bench.run("accumulate");
        EXPECT_EQ(bench.header().path_count, TILE_PIXELS);
        EXPECT_EQ(bench.film()[0].samples, 0U);
        EXPECT_EQ(bench.radiance(3, 0), value(3, 0));
    }
}

WAVELOBE_AT_EACH_WIDTH(Accumulate);

}  // namespace
}  // namespace wavelobe::test
