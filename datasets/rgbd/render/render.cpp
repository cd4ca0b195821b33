#include "datasets/rgbd/render/render.hpp"

#include <array>

namespace loopbench {
namespace {

// Light comes from above and from one side, so that edges of one paint can be told.
constexpr std::array<float, 6> kLight{0.85f, 1.0f, 0.9f, 0.95f, 0.8f, 1.05f};

}  // namespace

Rendered render(const Scene& scene, const Camera& camera, const Pose& world_from_camera) {
  const Matrix3 R = world_from_camera.rotation.toRotationMatrix();
  const Vector3 right = R.col(0) / camera.fx;
  const Vector3 down = R.col(1) / camera.fy;
  Rendered out{Image<float>(camera.width, camera.height),
               DepthImage(camera.width, camera.height),
               Image<float>(camera.width, camera.height)};
  for (int y = 0; y < camera.height; ++y) {
    const Vector3 row = R.col(2) + (y - camera.cy) * down;
    for (int x = 0; x < camera.width; ++x) {
      const Vector3 ray = row + (x - camera.cx) * right;
      const Hit hit = cast(scene, world_from_camera.translation, ray);
      const float footprint = hit.depth / (static_cast<float>(camera.fx) * hit.cosine);
      const float paint = sample(scene.textures[hit.skin], hit.u, hit.v, footprint);
      out.grey.at(x, y) = kLight[static_cast<std::size_t>(hit.face)] * paint;
      out.depth.at(x, y) = hit.depth;  // the ray advances one metre in z per unit
      out.slant.at(x, y) = hit.cosine;
    }
  }
  return out;
}

}  // namespace loopbench
