// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mean_edge_criterion.h"

#include "array_range.h"
#include "ear_cutting.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

MeanEdgeCriterion::MeanEdgeCriterion(
  TriangleTopology& topology, const NodalArrayView* array, Threads* threads)
  : topology_(topology)
  , heightField_(topology, threads)
  , array_(array)
  , scalar_(array && array->components == 1)
{
  const Index nodeCount = topology.nodeCount();
  if (array)
  {
    const ArrayRange range = arrayRange(*array, nodeCount);
    this->scale_ = range.size > 0.0 ? 1.0 / range.size : 0.0;
    doInShares(
      threads, nodeCount, [&](const Share& share) { this->setValues(range.lowest[0], share); });
  }
  topology.doInNodeShares(threads, [this](const auto& share) { this->addEdges(share); });
}

void MeanEdgeCriterion::setValues(double lowest, const Share& share)
{
  for (Index i = share.begin; i < share.end; ++i)
  {
    MeshNode& node = this->topology_.node(i);
    if (this->scalar_)
    {
      const double value = (this->array_->values[i] - lowest) * this->scale_;
      node.value =
        std::isfinite(value) ? static_cast<std::int32_t>(std::lround(value * kUnit)) : -1;
      node.kept = node.kept || node.value < 0;
    }
    else if (!isFinite(*this->array_, i))
    {
      node.kept = true;
    }
  }
}

// To some of the nodes, the sums of their edges.
template <typename Nodes>
void MeanEdgeCriterion::addEdges(const Nodes& share)
{
  this->topology_.visitTriangles(share,
    [&](Index t, const auto& ours)
    {
      const TriangleTopology::Triangle& triangle = this->topology_.triangle(t);
      for (int c = 0; c < 3; ++c)
      {
        // Each edge once: from its boundary side, or from the smaller of its two corners.
        const Corner across = triangle.across[c];
        const Index a = triangle.nodes[nextCorner(c)];
        const Index b = triangle.nodes[previousCorner(c)];
        if ((across == kNoCorner || makeCorner(t, c) < across) && (ours.has(a) || ours.has(b)))
        {
          MeshNode& nodeA = this->topology_.node(a);
          MeshNode& nodeB = this->topology_.node(b);
          const std::uint64_t sum = this->edgeSum(nodeA, nodeB, a, b);
          if (ours.has(a))
          {
            nodeA.sum += sum;
          }
          if (ours.has(b))
          {
            nodeB.sum += sum;
          }
        }
      }
    });
}

std::int64_t MeanEdgeCriterion::otherQuantity(Index a, Index b) const
{
  if (!this->array_)
  {
    const Vector edge = this->topology_.node(b).position - this->topology_.node(a).position;
    const double flat = std::sqrt(edge.x * edge.x + edge.y * edge.y);
    const double angle = std::atan2(std::abs(edge.z), flat);
    return std::isfinite(angle) ? std::llround(angle * (kUnit / std::acos(0.0))) : kWhole;
  }
  const int components = this->array_->components;
  const float* valuesA = this->array_->values + std::size_t{ 1 } * components * a;
  const float* valuesB = this->array_->values + std::size_t{ 1 } * components * b;
  double square = 0.0;
  for (int i = 0; i < components; ++i)
  {
    const double difference = static_cast<double>(valuesA[i]) - valuesB[i];
    square += difference * difference;
  }
  const double fraction = std::sqrt(square) * this->scale_;
  return fraction <= 1.0 ? std::llround(fraction * kUnit) : kWhole;
}

void MeanEdgeCriterion::addEdge(Index a, Index b)
{
  MeshNode& nodeA = this->topology_.node(a);
  MeshNode& nodeB = this->topology_.node(b);
  const std::uint64_t sum = this->edgeSum(nodeA, nodeB, a, b);
  nodeA.sum += sum;
  nodeB.sum += sum;
}

bool MeanEdgeCriterion::retriangulate(
  Index node, Hole& hole, HoleTriangulation& filling, double& cost)
{
  this->evaluate(node, cost);
  filling.count = 0;
  if (!this->topology_.gather(node, hole) || !this->topology_.isClosable(hole))
  {
    return false;
  }
  if (hole.size == 2)
  {
    return true;
  }
  const HoleRing ring(this->topology_, hole);
  EarCutting ears(ring.nodes.data(), hole.size, ring.normal);
  // In the plane of the mean normal no old triangle may lie upside down, else the hole is not the
  // polygon that the plane shows.
  if (!ears.seesFan(hole.triangleCount))
  {
    return false;
  }
  const int last = hole.size - 1;
  const bool cut = ears.cut(
    [&](int i, int j)
    {
      const bool closing = hole.boundary && (i + j == last && (i == 0 || j == 0));
      return closing || !this->topology_.mayHaveEdge(hole.ring[i], hole.ring[j]);
    },
    filling);
  return cut && ring.isUnfolded(hole, filling, this->heightField_);
}

void MeanEdgeCriterion::removed(const Hole& hole, const HoleTriangulation& filling)
{
  const MeshNode& node = this->topology_.node(hole.node);
  for (int i = 0; i < hole.size; ++i)
  {
    MeshNode& neighbour = this->topology_.node(hole.ring[i]);
    neighbour.sum -= this->edgeSum(node, neighbour, hole.node, hole.ring[i]);
  }
  // Every ear but the last one leaves a diagonal behind; at the boundary the hole closes as well.
  for (int t = 0; t + 1 < filling.count; ++t)
  {
    const auto& triangle = filling.triangles[t];
    this->addEdge(hole.ring[triangle[0]], hole.ring[triangle[2]]);
  }
  if (hole.boundary && filling.count > 0)
  {
    this->addEdge(hole.ring[0], hole.ring[hole.size - 1]);
  }
}

} // namespace undecimate
