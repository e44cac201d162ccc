// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file types.h
/// @brief Words that all of Core shares: index type, status, views of the caller's mesh.
///
/// Node = point of the mesh (the finite-element word), cell = triangle. The core never owns the
/// caller's arrays, never throws across its interface and includes no host toolkit.

#ifndef UNDECIMATE_CORE_TYPES_H
#define UNDECIMATE_CORE_TYPES_H

#include <cstdint>
#include <string>
#include <vector>

namespace undecimate
{

/// Node and cell numbers are 32-bit: memory traffic is what bounds the speed. A piece with more
/// than 2^31 - 1 nodes or 2^29 - 1 triangles is refused with Status::TooLarge.
using Index = std::int32_t;

/// No node or no cell.
constexpr Index kNone = -1;

/// How a call ended.
enum class Status
{
  Ok,              ///< done
  Cancelled,       ///< the monitor asked to stop; outputs are empty
  InvalidArgument, ///< an option or an array does not fit; the message names it
  InvalidRecord,   ///< the record is damaged or of a future version; the message says where
  TooLarge,        ///< more nodes, triangles or shapes of steps than 32-bit numbers allow
  OutOfMemory      ///< an allocation failed; outputs are empty
};

/// A status and, unless it is Ok, one sentence that names the culprit and the next step.
struct Outcome
{
  Status status = Status::Ok;
  std::string message;

  explicit operator bool() const { return this->status == Status::Ok; }
};

/// A triangle mesh in the caller's memory. Exactly one of the two point arrays and one of the two
/// triangle arrays is set.
struct TriangleMeshView
{
  const float* pointsFloat = nullptr;   ///< 3 * nodeCount coordinates, or null
  const double* pointsDouble = nullptr; ///< 3 * nodeCount coordinates, or null
  std::int64_t nodeCount = 0;
  const Index* triangles = nullptr; ///< 3 * triangleCount node numbers in [0, nodeCount), or null
  const std::int64_t* wideTriangles = nullptr; ///< the same in 64 bits, or null
  std::int64_t triangleCount = 0;
  const unsigned char* keep = nullptr; ///< nodeCount flags, nonzero = never remove; or null
};

/// A nodal result that steers the decimation: scalars (components == 1) or vectors.
struct NodalArrayView
{
  const float* values = nullptr; ///< components * nodeCount values
  int components = 1;            ///< 1 to 9; vectors are compared by the norm of the difference
  std::string name;              ///< for messages
};

} // namespace undecimate

#endif
