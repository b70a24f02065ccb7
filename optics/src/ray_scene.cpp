#include "optics/ray_scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "cad_import/error.h"
#include "optics/src/embree_handles.h"

namespace catoptra::optics {
namespace {

// RayPacket16 is handed to Embree as it is.
static_assert(sizeof(RayPacket16) == sizeof(RTCRayHit16) && alignof(RayPacket16) == alignof(RTCRayHit16));
static_assert(sizeof(ShadowPacket16) == sizeof(RTCRay16) && alignof(ShadowPacket16) == alignof(RTCRay16));
static_assert(offsetof(ShadowPacket16, t_min) == offsetof(RTCRay16, tnear));
static_assert(offsetof(ShadowPacket16, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(ShadowPacket16, t_max) == offsetof(RTCRay16, tfar));
static_assert(offsetof(ShadowPacket16, flags) == offsetof(RTCRay16, flags));
static_assert(RTC_MAX_INSTANCE_LEVEL_COUNT == 1 && kNoHit == RTC_INVALID_GEOMETRY_ID);
static_assert(offsetof(RayPacket16, t_min) == offsetof(RTCRay16, tnear));
static_assert(offsetof(RayPacket16, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(RayPacket16, t_max) == offsetof(RTCRay16, tfar));
static_assert(offsetof(RayPacket16, mask) == offsetof(RTCRay16, mask));
static_assert(offsetof(RayPacket16, normal_x) == offsetof(RTCRayHit16, hit) + offsetof(RTCHit16, Ng_x));
static_assert(offsetof(RayPacket16, u) == offsetof(RTCRayHit16, hit) + offsetof(RTCHit16, u));
static_assert(offsetof(RayPacket16, triangle) == offsetof(RTCRayHit16, hit) + offsetof(RTCHit16, primID));
static_assert(offsetof(RayPacket16, object) == offsetof(RTCRayHit16, hit) + offsetof(RTCHit16, geomID));

constexpr std::size_t kLanes = 16;
constexpr std::size_t kSerialRays = 512;  // below this a batch costs less than waking other threads

// One Embree geometry: an optic, or the opaque or the alpha-tested triangles of surroundings.
struct Part {
  EmbreeGeometry geometry;
  std::uint32_t object = 0;
  std::vector<std::uint32_t> triangle_of;   // index in the object's triangles; empty: the same
  std::span<const glm::vec3> positions;     // in Embree's buffer
  std::vector<glm::dvec3> exact_positions;  // of an optic
  std::span<const glm::uvec3> triangles;    // in Embree's buffer
  AlphaTest alpha_test;

  std::uint32_t object_triangle(std::uint32_t triangle) const {
    return triangle_of.empty() ? triangle : triangle_of[triangle];
  }
  glm::dvec3 position(std::uint32_t vertex) const {
    return exact_positions.empty() ? glm::dvec3(positions[vertex]) : exact_positions[vertex];
  }
};

// Called by Embree for hits on alpha-tested parts only.
void filter_alpha(const RTCFilterFunctionNArguments* arguments) {
  const Part& part = *static_cast<const Part*>(arguments->geometryUserPtr);
  const unsigned int n = arguments->N;
  for (unsigned int i = 0; i < n; ++i) {
    if (arguments->valid[i] != -1) continue;
    const std::uint32_t triangle = part.object_triangle(RTCHitN_primID(arguments->hit, n, i));
    if (!part.alpha_test(triangle, RTCHitN_u(arguments->hit, n, i), RTCHitN_v(arguments->hit, n, i)))
      arguments->valid[i] = 0;
  }
}

void check_indices(const std::string& file, std::span<const glm::uvec3> triangles, std::size_t vertex_count) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t highest = std::max({triangles[i].x, triangles[i].y, triangles[i].z});
    if (highest >= vertex_count)
      throw Error(file, "triangle " + std::to_string(i),
                  "refers to vertex " + std::to_string(highest) + " of " + std::to_string(vertex_count));
  }
}

RTCIntersectContext query_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

/// What Embree wants to know of a lane besides its ray, of packets with hits and without.
template <typename Packet>
void prepare_lane(Packet& packet, std::size_t i, std::uint32_t mask, int (&valid)[kLanes]) {
  valid[i] = packet.t_max[i] >= packet.t_min[i] ? -1 : 0;
  packet.mask[i] = mask;
  packet.time[i] = 0;
  packet.flags[i] = 0;
}

template <typename EmbreeRay>
void set_ray(EmbreeRay& out, const Ray& ray, std::uint32_t mask) {
  out.org_x = static_cast<float>(ray.origin_mm.x);
  out.org_y = static_cast<float>(ray.origin_mm.y);
  out.org_z = static_cast<float>(ray.origin_mm.z);
  out.dir_x = static_cast<float>(ray.direction.x);
  out.dir_y = static_cast<float>(ray.direction.y);
  out.dir_z = static_cast<float>(ray.direction.z);
  out.tnear = static_cast<float>(ray.t_min_mm);
  out.tfar = static_cast<float>(ray.t_max_mm);
  out.time = 0;
  out.mask = mask;
  out.id = 0;
  out.flags = 0;
}

// A ray that meets nothing.
const Ray kNoRay{{0, 0, 0}, {0, 0, 1}, 0, -1};

// Whether Embree can follow the ray: it takes no care of what is not finite, or beyond 1e18 mm.
bool can_be_traced(const Ray& ray) {
  constexpr double kLargest = 1e18;
  const auto fits = [](double x) { return std::abs(x) < kLargest; };  // not where x is no number
  const glm::dvec3 &o = ray.origin_mm, &d = ray.direction;
  return fits(o.x) && fits(o.y) && fits(o.z) && fits(d.x) && fits(d.y) && fits(d.z) && fits(ray.t_min_mm) &&
         !std::isnan(ray.t_max_mm);
}

void set_lane(RayPacket16& packet, std::size_t i, const Ray& ray) {
  packet.origin_x[i] = static_cast<float>(ray.origin_mm.x);
  packet.origin_y[i] = static_cast<float>(ray.origin_mm.y);
  packet.origin_z[i] = static_cast<float>(ray.origin_mm.z);
  packet.direction_x[i] = static_cast<float>(ray.direction.x);
  packet.direction_y[i] = static_cast<float>(ray.direction.y);
  packet.direction_z[i] = static_cast<float>(ray.direction.z);
  packet.t_min[i] = static_cast<float>(ray.t_min_mm);
  packet.t_max[i] = static_cast<float>(ray.t_max_mm);
}

}  // namespace

struct RayScene::Impl {
  struct Object {
    std::size_t triangle_count = 0;
    std::uint32_t optic_part = kNoHit;  // surroundings: none
    std::uint32_t mask = 0;             // of an optic
  };

  EmbreeDevice device;
  EmbreeScene scene;
  std::vector<std::unique_ptr<Part>> parts;  // by geometry number; their addresses are known to Embree
  std::vector<Object> objects;
  bool parts_are_objects = true;  // no object was split, so that geometry numbers are object numbers

  Impl() : device(rtcNewDevice(nullptr)) {
    if (!device) {
      check_embree(nullptr, "starting");
      throw Error("", "ray scene", "Embree cannot be started");
    }
    if (rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) == 0)
      throw Error("", "ray scene", "this build of Embree has no ray masks",
                  "install one built with EMBREE_RAY_MASK=ON");
    scene.reset(rtcNewScene(device.get()));
    // A scene of quality LOW is a hierarchy over one hierarchy per geometry, each of the geometry's own
    // quality: what moves is refitted, and nothing else is touched (tests/bench). ROBUST costs about a
    // seventh of the speed; without it some 4 % of the rays that meet a shared edge exactly slip through, and
    // vertex rays do meet edges.
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    check_embree(device.get(), "starting");
  }

  EmbreeBuffer position_buffer(std::size_t count) const {
    // Embree reads 16 bytes at each vertex, so the last one needs 4 more.
    EmbreeBuffer buffer(rtcNewBuffer(device.get(), (count + 2) * sizeof(glm::vec3)));
    check_embree(device.get(), "allocating vertices");
    return buffer;
  }

  std::unique_ptr<Part> make_part(std::uint32_t object, RTCBuffer positions, std::size_t vertex_count,
                                  std::span<const glm::uvec3> triangles, std::uint32_t mask) const {
    auto part = std::make_unique<Part>();
    part->object = object;
    part->geometry.reset(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    RTCGeometry geometry = part->geometry.get();
    const bool moves = (mask & kSurroundings) == 0;
    rtcSetGeometryBuildQuality(geometry, moves ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetGeometryMask(geometry, mask);
    rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0,
                         sizeof(glm::vec3), vertex_count);
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(glm::uvec3), triangles.size());
    check_embree(device.get(), "allocating triangles");
    std::memcpy(indices, triangles.data(), triangles.size_bytes());
    part->positions = {static_cast<const glm::vec3*>(rtcGetBufferData(positions)), vertex_count};
    part->triangles = {static_cast<const glm::uvec3*>(indices), triangles.size()};
    return part;
  }

  void attach(std::unique_ptr<Part> part) {
    rtcCommitGeometry(part->geometry.get());
    const auto number = static_cast<std::uint32_t>(parts.size());
    rtcAttachGeometryByID(scene.get(), part->geometry.get(), number);
    check_embree(device.get(), "adding triangles");
    parts_are_objects = parts_are_objects && part->object == number;
    parts.push_back(std::move(part));
  }

  std::unique_ptr<Part> make_optic_part(std::uint32_t object, const tessellate::OpticArrays& mesh,
                                        std::uint32_t mask) const {
    std::vector<glm::uvec3> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles) triangles.emplace_back(t.vertices[0], t.vertices[1], t.vertices[2]);
    check_indices("", triangles, mesh.vertices.size());
    const EmbreeBuffer buffer = position_buffer(mesh.vertices.size());
    auto part = make_part(object, buffer.get(), mesh.vertices.size(), triangles, mask);
    set_optic_positions(*part, mesh);
    return part;
  }

  static void set_optic_positions(Part& part, const tessellate::OpticArrays& mesh) {
    auto* positions =
        static_cast<glm::vec3*>(rtcGetGeometryBufferData(part.geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0));
    part.exact_positions.resize(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      part.exact_positions[i] = mesh.vertices[i].position_mm;
      positions[i] = glm::vec3(mesh.vertices[i].position_mm);
    }
  }

  // The hit in double precision: the ray against the plane of the triangle that the float query found.
  // Source: Moller and Trumbore, Journal of Graphics Tools 2(1), 1997.
  Hit exact(const Ray& ray, std::uint32_t geometry, std::uint32_t triangle, float t_query) const {
    if (geometry == kNoHit) return {};
    const Part& part = *parts[geometry];
    const glm::uvec3 corner = part.triangles[triangle];
    const glm::dvec3 a = part.position(corner.x);
    const glm::dvec3 e1 = part.position(corner.y) - a, e2 = part.position(corner.z) - a;
    const glm::dvec3 p = glm::cross(ray.direction, e2);
    const double determinant = glm::dot(e1, p);
    Hit hit{t_query, part.object, part.object_triangle(triangle), {0, 0}};
    if (determinant == 0) return hit;  // edge-on to double precision: the float distance has to do
    const glm::dvec3 s = ray.origin_mm - a, q = glm::cross(s, e1);
    hit.t_mm = glm::dot(e2, q) / determinant;
    hit.barycentric = {glm::dot(s, p) / determinant, glm::dot(ray.direction, q) / determinant};
    return hit;
  }

  // Leaves Embree's own geometry and triangle numbers in the packet.
  void query(RayPacket16& packet, std::uint32_t mask, bool coherent) const {
    alignas(64) int valid[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) {
      prepare_lane(packet, i, mask, valid);
      packet.object[i] = kNoHit;
      packet.instance[i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context = query_context(coherent);
    rtcIntersect16(valid, scene.get(), &context, reinterpret_cast<RTCRayHit16*>(&packet));
  }

  void query_block(std::span<const Ray> rays, std::span<Hit> hits, std::uint32_t mask) const {
    RayPacket16 packet;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool active = i < rays.size() && can_be_traced(rays[i]);
      set_lane(packet, i, active ? rays[i] : kNoRay);
    }
    query(packet, mask, true);
    for (std::size_t i = 0; i < rays.size(); ++i)
      hits[i] = exact(rays[i], packet.object[i], packet.triangle[i], packet.t_max[i]);
  }
};

RayScene::RayScene() : impl_(std::make_unique<Impl>()) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::uint32_t RayScene::add_surroundings(const cad_import::TriangleMesh& mesh, AlphaTest alpha_test) {
  check_indices(mesh.file, mesh.triangles, mesh.positions.size());
  const auto object = static_cast<std::uint32_t>(impl_->objects.size());
  std::vector<std::uint32_t> opaque, tested;
  for (std::uint32_t i = 0; alpha_test && i < mesh.triangles.size(); ++i) {
    const auto& material = mesh.materials.at(mesh.triangle_material.at(i));
    (material.alpha_cutoff > 0 ? tested : opaque).push_back(i);
  }
  const EmbreeBuffer buffer = impl_->position_buffer(mesh.positions.size());
  std::memcpy(rtcGetBufferData(buffer.get()), mesh.positions.data(),
              mesh.positions.size() * sizeof(glm::vec3));

  const auto subset = [&](const std::vector<std::uint32_t>& indices, std::uint32_t mask) {
    std::vector<glm::uvec3> triangles;
    for (const std::uint32_t i : indices) triangles.push_back(mesh.triangles[i]);
    auto part = impl_->make_part(object, buffer.get(), mesh.positions.size(), triangles, mask);
    part->triangle_of = indices;
    return part;
  };
  if (tested.empty()) {
    impl_->attach(impl_->make_part(object, buffer.get(), mesh.positions.size(), mesh.triangles,
                                   kSurroundings | kCasters));
  } else {
    if (!opaque.empty()) impl_->attach(subset(opaque, kSurroundings | kCasters));
    auto part = subset(tested, kSurroundings);
    part->alpha_test = std::move(alpha_test);
    rtcSetGeometryUserData(part->geometry.get(), part.get());
    rtcSetGeometryIntersectFilterFunction(part->geometry.get(), filter_alpha);
    rtcSetGeometryOccludedFilterFunction(part->geometry.get(), filter_alpha);
    impl_->parts_are_objects = false;
    impl_->attach(std::move(part));
  }
  impl_->objects.push_back({mesh.triangles.size()});
  return object;
}

std::uint32_t RayScene::add_optic(const tessellate::OpticArrays& mesh, std::uint32_t mask) {
  const auto object = static_cast<std::uint32_t>(impl_->objects.size());
  auto part = impl_->make_optic_part(object, mesh, mask);
  impl_->objects.push_back({mesh.triangles.size(), static_cast<std::uint32_t>(impl_->parts.size()), mask});
  impl_->attach(std::move(part));
  return object;
}

void RayScene::update_optic(std::uint32_t object, const tessellate::OpticArrays& mesh) {
  if (object >= impl_->objects.size() || impl_->objects[object].optic_part == kNoHit)
    throw Error("", "ray scene", "object " + std::to_string(object) + " is not an optic");
  Impl::Object& entry = impl_->objects[object];
  Part& part = *impl_->parts[entry.optic_part];
  const bool same = part.positions.size() == mesh.vertices.size() &&
                    std::ranges::equal(part.triangles, mesh.triangles, [](const auto& a, const auto& b) {
                      return a.x == b.vertices[0] && a.y == b.vertices[1] && a.z == b.vertices[2];
                    });
  if (same) {
    Impl::set_optic_positions(part, mesh);
    rtcUpdateGeometryBuffer(part.geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(part.geometry.get());
  } else {
    auto fresh = impl_->make_optic_part(object, mesh, entry.mask);
    rtcCommitGeometry(fresh->geometry.get());
    rtcDetachGeometry(impl_->scene.get(), entry.optic_part);
    rtcAttachGeometryByID(impl_->scene.get(), fresh->geometry.get(), entry.optic_part);
    impl_->parts[entry.optic_part] = std::move(fresh);
    entry.triangle_count = mesh.triangles.size();
  }
  check_embree(impl_->device.get(), "updating an optic");
}

void RayScene::commit() {
  rtcCommitScene(impl_->scene.get());
  check_embree(impl_->device.get(), "building");
}

Hit RayScene::intersect(const Ray& ray, std::uint32_t mask) const {
  if (!can_be_traced(ray)) return {};
  RTCRayHit query;
  set_ray(query.ray, ray, mask);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context = query_context(false);
  rtcIntersect1(impl_->scene.get(), &context, &query);
  return impl_->exact(ray, query.hit.geomID, query.hit.primID, query.ray.tfar);
}

std::vector<Hit> RayScene::intersect(std::span<const Ray> rays, std::uint32_t mask) const {
  std::vector<Hit> hits(rays.size());
  const std::size_t blocks = (rays.size() + kLanes - 1) / kLanes;
  const auto run = [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const std::size_t first = b * kLanes, count = std::min(kLanes, rays.size() - first);
      impl_->query_block(rays.subspan(first, count), std::span(hits).subspan(first, count), mask);
    }
  };
  if (rays.size() < kSerialRays)
    run(0, blocks);
  else
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 8),
                      [&](const auto& range) { run(range.begin(), range.end()); });
  return hits;
}

void RayScene::intersect16(RayPacket16& packet, std::uint32_t mask, bool coherent) const {
  impl_->query(packet, mask, coherent);
  if (impl_->parts_are_objects) return;
  for (std::size_t i = 0; i < kLanes; ++i) {
    if (packet.object[i] == kNoHit) continue;
    const Part& part = *impl_->parts[packet.object[i]];
    packet.object[i] = part.object;
    packet.triangle[i] = part.object_triangle(packet.triangle[i]);
  }
}

std::uint32_t RayScene::occluded16(ShadowPacket16& packet, std::uint32_t mask, bool coherent) const {
  alignas(64) int valid[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) prepare_lane(packet, i, mask, valid);
  RTCIntersectContext context = query_context(coherent);
  rtcOccluded16(valid, impl_->scene.get(), &context, reinterpret_cast<RTCRay16*>(&packet));
  std::uint32_t met = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    // Embree marks an occluded ray by tfar = -infinity.
    const bool blocked = valid[i] != 0 && packet.t_max[i] == -std::numeric_limits<float>::infinity();
    met |= blocked ? 1u << i : 0u;
  }
  return met;
}

bool RayScene::occluded(const Ray& ray, std::uint32_t mask) const {
  if (!can_be_traced(ray)) return false;
  RTCRay query;
  set_ray(query, ray, mask);
  RTCIntersectContext context = query_context(false);
  rtcOccluded1(impl_->scene.get(), &context, &query);
  return query.tfar < 0;  // Embree marks an occluded ray by tfar = -infinity
}

std::size_t RayScene::object_count() const {
  return impl_->objects.size();
}

std::size_t RayScene::triangle_count() const {
  return std::accumulate(
      impl_->objects.begin(), impl_->objects.end(), std::size_t{0},
      [](std::size_t sum, const Impl::Object& object) { return sum + object.triangle_count; });
}

}  // namespace catoptra::optics
