// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file cell_sources.h
/// @brief Which old triangle each new triangle of a hole covers most.

#ifndef UNDECIMATE_CORE_CELL_SOURCES_H
#define UNDECIMATE_CORE_CELL_SOURCES_H

#include "triangle_topology.h"

namespace undecimate
{

/// For each new triangle the old triangle (position in Hole::corners) with which it shares the
/// largest area, seen along the mean normal of the old ones; the first of equals.
/// @param[out] sources filling.count entries
/// Complexity: O(old * new).
void findCellSources(const TriangleTopology& topology, const Hole& hole,
  const HoleTriangulation& filling, unsigned char* sources);

} // namespace undecimate

#endif
