// Tests of the renderer: exact values in simple cases, and reproducibility.
#include <cmath>

#include "datasets/images/render/rendered_room.hpp"
#include "datasets/images/render/scene.hpp"

namespace loopbench::render_test {

using namespace rgbd;

namespace {

RenderOptions tiny() { return {.width = 80, .rate = 2.0, .laps = 0.1}; }

RenderOptions exact() {
  RenderOptions out = tiny();
  out.depth_noise = 0.0;
  out.dropouts = 0.0;
  return out;
}

RgbdFrame frame(const RenderOptions& options, std::size_t index) {
  std::string why;
  return *rendered_room(options)->read(index, why);
}

Scene bare_room() {
  Scene scene;
  scene.textures.push_back({200.0f, {GreyImage(8, 8, 100)}});
  scene.room = {{-1.0, -2.0, -3.0}, {1.0, 2.0, 3.0}, {0, 0, 0, 0, 0, 0}};
  return scene;
}

TEST(Render, ARayMeetsTheWallWhereGeometrySays) {
  const Scene scene = bare_room();
  const Hit ahead = cast_ray(scene, {0.5, 0.0, 0.0}, {1.0, 0.0, 0.0});
  EXPECT_EQ(ahead.face, 1);
  EXPECT_FLOAT_EQ(ahead.depth, 0.5f);
  EXPECT_FLOAT_EQ(ahead.cosine, 1.0f);
  EXPECT_FLOAT_EQ(ahead.u, 2.0f);  // y from the corner
  EXPECT_FLOAT_EQ(ahead.v, 3.0f);  // z from the corner
  const Hit down = cast_ray(scene, {0.0, 0.0, 0.0}, {0.0, 0.6, -1.8});
  EXPECT_EQ(down.face, 4);
  EXPECT_NEAR(down.depth, 3.0 / 1.8, 1e-6);
  EXPECT_NEAR(down.cosine, 1.8 / std::hypot(0.6, 1.8), 1e-6);
}

TEST(Render, FurnitureHidesTheWallBehindIt) {
  Scene scene = bare_room();
  scene.furniture.push_back({{0.7, -0.5, -0.5}, {1.0, 0.5, 0.5}, {0, 0, 0, 0, 0, 0}});
  EXPECT_FLOAT_EQ(cast_ray(scene, {0, 0, 0}, {1.0, 0.0, 0.0}).depth, 0.7f);
  EXPECT_EQ(cast_ray(scene, {0, 0, 0}, {1.0, 0.0, 0.0}).face, 0);
  EXPECT_FLOAT_EQ(cast_ray(scene, {0, 0, 0}, {1.0, 0.9, 0.0}).depth, 1.0f);
}

TEST(Render, DepthIsAlongTheAxisSoAFlatWallIsFlat) {
  const Camera camera{.width = 32, .height = 24, .fx = 30.0, .fy = 30.0, .cx = 15.5, .cy = 11.5};
  Matrix3 R;  // camera looks along x
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const RenderedImage rendered = render(bare_room(), camera, {Rotation(R), {0.2, 0.0, 0.0}});
  for (const float depth : rendered.depth.pixels) EXPECT_NEAR(depth, 0.8, 1e-6);
}

TEST(Render, TexturesAreFullOfContrastAndFollowTheSeed) {
  const Texture a = dead_leaves(1.0, 1.0, 1.0, 7);
  EXPECT_EQ(a.levels.front().width, 200);
  EXPECT_EQ(a.levels.front().pixels, dead_leaves(1.0, 1.0, 1.0, 7).levels.front().pixels);
  EXPECT_NE(a.levels.front().pixels, dead_leaves(1.0, 1.0, 1.0, 8).levels.front().pixels);
  double sum = 0.0;
  double squares = 0.0;
  for (const std::uint8_t grey : a.levels.front().pixels) {
    sum += grey;
    squares += grey * grey;
  }
  const double mean = sum / 40000.0;
  EXPECT_GT(std::sqrt(squares / 40000.0 - mean * mean), 30.0);
  EXPECT_NEAR(sample(a, 0.5f, 0.5f, 1.0f), mean, 40.0);  // coarse level: close to the mean
}

TEST(Sensor, WithoutNoiseDepthIsExactToTheMillimetre) {
  const auto source = rendered_room(exact());
  const RgbdFrame image = frame(exact(), 3);
  const Camera camera = source->camera();
  const Pose pose = source->reference()[12].world_from_body;  // four times the rate
  std::size_t on_wall = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto z = static_cast<double>(image.depth.at(x, y));
      if (z == 0.0) continue;
      const Vector3 p = (pose * camera.back_project(x, y, z)).cwiseAbs();
      const Vector3 half(2.7, 2.4, 1.35);
      EXPECT_TRUE(((half - p).array() > -2e-3).all());
      on_wall += ((half - p).array().abs() < 2e-3).any() ? 1u : 0u;
    }
  }
  EXPECT_GT(on_wall, 500u);
}

TEST(Sensor, NoiseGrowsWithTheSquareOfDepthAndHolesAppear) {
  const RgbdFrame clean = frame(exact(), 2);
  const RgbdFrame noisy = frame(tiny(), 2);
  std::size_t holes = 0;
  std::size_t near = 0;
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < clean.depth.pixels.size(); ++i) {
    const float z = clean.depth.pixels[i];
    if (z == 0.0f) continue;
    ++pixels;
    if (noisy.depth.pixels[i] == 0.0f) {
      ++holes;
    } else if (std::abs(noisy.depth.pixels[i] - z) < 5.0f * 1.425e-3f * z * z + 0.05f) {
      ++near;
    }
  }
  EXPECT_GT(holes, pixels / 100);
  EXPECT_LT(holes, pixels / 4);
  EXPECT_GT(near, (pixels - holes) * 9 / 10);
}

TEST(RenderedRoom, GivesTheSameBitsWhoeverAsksInWhateverOrder) {
  const auto source = rendered_room(tiny());
  std::string why;
  const RgbdFrame late = *source->read(4, why);
  const RgbdFrame early = *source->read(1, why);
  EXPECT_EQ(late.grey.pixels, frame(tiny(), 4).grey.pixels);
  EXPECT_EQ(late.depth.pixels, frame(tiny(), 4).depth.pixels);
  EXPECT_NE(early.grey.pixels, late.grey.pixels);
  RenderOptions other = tiny();
  other.seed = 2;
  EXPECT_NE(frame(other, 4).grey.pixels, late.grey.pixels);
}

TEST(RenderedRoom, KnowsItsReferenceAtFourTimesTheRate) {
  const auto source = rendered_room(tiny());
  ASSERT_EQ(source->size(), 10u);  // 4.89 s at 2 Hz, including the first frame
  ASSERT_EQ(source->reference().size(), 37u);
  EXPECT_DOUBLE_EQ(source->reference().back().stamp, source->stamp(9));
}

}  // namespace
}  // namespace loopbench::render_test
