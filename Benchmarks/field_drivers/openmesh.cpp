// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file openmesh.cpp
/// @brief OpenMesh as a rival: half-edge collapses by quadrics (ModQuadricT). With RIVAL_VARIANT 1
/// also ModNormalFlippingT, which refuses collapses that turn a triangle by over 90 degrees.

#include "rival.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/config.h>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

namespace
{

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

struct Handle
{
  Mesh mesh;
  OpenMesh::VPropHandleT<double> values;
  bool hasValues = false;
};

} // namespace

void* rivalCreate(const double* points, std::int64_t nodeCount, const std::int32_t* triangles,
  std::int64_t triangleCount, const double* values)
{
  auto* h = new Handle;
  h->hasValues = values != nullptr;
  if (h->hasValues)
  {
    h->mesh.add_property(h->values);
  }
  for (std::int64_t i = 0; i < nodeCount; ++i)
  {
    const double* p = points + 3 * i;
    const auto node = h->mesh.add_vertex(
      Mesh::Point(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])));
    if (h->hasValues)
    {
      h->mesh.property(h->values, node) = values[i];
    }
  }
  for (std::int64_t i = 0; i < triangleCount; ++i)
  {
    const std::int32_t* t = triangles + 3 * i;
    // A triangle at a non-manifold edge is refused and left out, with a message on stderr.
    h->mesh.add_face(Mesh::VertexHandle(t[0]), Mesh::VertexHandle(t[1]), Mesh::VertexHandle(t[2]));
  }
  return h;
}

int rivalRun(void* handle, std::int64_t triangles)
{
  Handle& h = *static_cast<Handle*>(handle);
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(h.mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
#if RIVAL_VARIANT == 1
  OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
  decimater.add(flipping);
  decimater.module(flipping).set_max_normal_deviation(90);
#endif
  if (!decimater.initialize())
  {
    return 1;
  }
  decimater.decimate_to_faces(0, static_cast<std::size_t>(triangles));
  h.mesh.garbage_collection();
  return 0;
}

std::int64_t rivalNodeCount(const void* handle)
{
  return static_cast<std::int64_t>(static_cast<const Handle*>(handle)->mesh.n_vertices());
}

std::int64_t rivalTriangleCount(const void* handle)
{
  return static_cast<std::int64_t>(static_cast<const Handle*>(handle)->mesh.n_faces());
}

int rivalHasValues(const void* handle)
{
  return static_cast<const Handle*>(handle)->hasValues ? 1 : 0;
}

void rivalGet(const void* handle, double* points, std::int32_t* triangles, double* values)
{
  const Handle& h = *static_cast<const Handle*>(handle);
  for (const auto node : h.mesh.vertices())
  {
    const Mesh::Point& p = h.mesh.point(node);
    for (int axis = 0; axis < 3; ++axis)
    {
      points[3 * node.idx() + axis] = p[axis];
    }
    if (values != nullptr)
    {
      values[node.idx()] = h.mesh.property(h.values, node);
    }
  }
  for (const auto face : h.mesh.faces())
  {
    for (auto node = h.mesh.cfv_iter(face); node.is_valid(); ++node)
    {
      *triangles++ = node->idx();
    }
  }
}

void rivalDestroy(void* handle)
{
  delete static_cast<Handle*>(handle);
}

const char* rivalVersion()
{
  // OM_VERSION is 0xMmmpp: major, minor, patch.
  static const std::string version = std::to_string(OM_VERSION >> 16) + "." +
    std::to_string((OM_VERSION >> 8) & 0xFF) + "." + std::to_string(OM_VERSION & 0xFF);
  return version.c_str();
}
