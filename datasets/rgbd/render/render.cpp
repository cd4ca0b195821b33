#include "datasets/rgbd/render/render.hpp"

#include <array>

namespace loopbench::rgbd {
namespace {

// Brightness of the faces. It differs so that edges between faces of equal texture are visible.
constexpr std::array<float, 6> kLight{0.85f, 1.0f, 0.9f, 0.95f, 0.8f, 1.05f};

}  // namespace

RenderedImage render(const Scene& scene, const Camera& camera, const Pose& world_from_camera) {
  const Matrix3 R = world_from_camera.rotation.toRotationMatrix();
  const Vector3 right = R.col(0) / camera.fx;
  const Vector3 down = R.col(1) / camera.fy;
  RenderedImage out{Image<float>(camera.width, camera.height),
                    DepthImage(camera.width, camera.height),
                    Image<float>(camera.width, camera.height)};
  for (int y = 0; y < camera.height; ++y) {
    const Vector3 row = R.col(2) + (y - camera.cy) * down;
    for (int x = 0; x < camera.width; ++x) {
      const Vector3 ray = row + (x - camera.cx) * right;
      const Hit hit = cast_ray(scene, world_from_camera.translation, ray);
      const float footprint = hit.depth / (static_cast<float>(camera.fx) * hit.cosine);
      const float texel = sample(scene.textures[hit.skin], hit.u, hit.v, footprint);
      out.grey.at(x, y) = kLight[static_cast<std::size_t>(hit.face)] * texel;
      out.depth.at(x, y) = hit.depth;  // rays have unit length along the optical axis
      out.incidence_cosine.at(x, y) = hit.cosine;
    }
  }
  return out;
}

}  // namespace loopbench::rgbd
