// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file cgal.cpp
/// @brief CGAL's edge collapse as a rival. RIVAL_VARIANT: 0 Lindstrom-Turk (its default), 1
/// Garland-Heckbert with planes and bounded change of the normals.
///
/// Links GPL code: a tool for measuring, never installed.

#include "rival.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/version_macros.h>

namespace
{

namespace Simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// Stops at a number of triangles; CGAL's own predicates count edges.
struct AtTriangles
{
  const Mesh* mesh;
  std::size_t wanted;

  template <typename Cost, typename Profile>
  bool operator()(const Cost&, const Profile&, std::size_t, std::size_t) const
  {
    return this->mesh->number_of_faces() <= this->wanted;
  }
};

} // namespace

void* rivalCreate(const double* points, std::int64_t nodeCount, const std::int32_t* triangles,
  std::int64_t triangleCount, const double*)
{
  auto* mesh = new Mesh;
  for (std::int64_t i = 0; i < nodeCount; ++i)
  {
    mesh->add_vertex(Kernel::Point_3(points[3 * i], points[3 * i + 1], points[3 * i + 2]));
  }
  for (std::int64_t i = 0; i < triangleCount; ++i)
  {
    const auto corner = [&](int c)
    { return Mesh::Vertex_index(static_cast<Mesh::size_type>(triangles[3 * i + c])); };
    // A triangle at a non-manifold edge is refused and left out.
    mesh->add_face(corner(0), corner(1), corner(2));
  }
  return mesh;
}

int rivalRun(void* handle, std::int64_t triangles)
{
  Mesh& mesh = *static_cast<Mesh*>(handle);
  const AtTriangles stop{ &mesh, static_cast<std::size_t>(triangles) };
#if RIVAL_VARIANT == 1
  using Policies = Simplification::GarlandHeckbert_plane_policies<Mesh, Kernel>;
  const Policies policies(mesh);
  const Simplification::Bounded_normal_change_placement<Policies::Get_placement> placement(
    policies.get_placement());
  Simplification::edge_collapse(
    mesh, stop, CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
#else
  Simplification::edge_collapse(mesh, stop);
#endif
  mesh.collect_garbage();
  return 0;
}

std::int64_t rivalNodeCount(const void* handle)
{
  return static_cast<const Mesh*>(handle)->number_of_vertices();
}

std::int64_t rivalTriangleCount(const void* handle)
{
  return static_cast<const Mesh*>(handle)->number_of_faces();
}

int rivalHasValues(const void*)
{
  return 0;
}

void rivalGet(const void* handle, double* points, std::int32_t* triangles, double*)
{
  const Mesh& mesh = *static_cast<const Mesh*>(handle);
  for (const auto node : mesh.vertices())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      points[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(axis)] =
        mesh.point(node)[axis];
    }
  }
  for (const auto face : mesh.faces())
  {
    for (const auto node : CGAL::vertices_around_face(mesh.halfedge(face), mesh))
    {
      *triangles++ = static_cast<std::int32_t>(static_cast<std::size_t>(node));
    }
  }
}

void rivalDestroy(void* handle)
{
  delete static_cast<Mesh*>(handle);
}

const char* rivalVersion()
{
  return CGAL_STR(CGAL_VERSION);
}
