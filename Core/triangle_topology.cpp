// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "triangle_topology.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <new>

namespace undecimate
{

namespace
{

// Do a job for the indices [begin, end) of blocks of [0, count).
template <typename Job>
void doInBlocks(Threads* threads, Index count, Index block, const Job& job)
{
  if (!threads)
  {
    job(0, count);
    return;
  }
  threads->run(count / block + 1,
    [&](Index i, int /*thread*/) { job(i * block, i < count / block ? (i + 1) * block : count); });
}

constexpr Index kBlock = 1 << 14;

struct ListedCorner
{
  Corner corner;
  Index from; // the node after it
};

// In a list of corners, the one opposite to the edge between two nodes, or kNoCorner.
template <typename Behind>
ListedCorner findListed(const TriangleTopology::Triangle* triangles, Corner first,
  const Behind& behind, Index from, Index to)
{
  Index otherFrom = kNone;
  for (; first != kNoCorner; first = behind(first))
  {
    const auto& nodes = triangles[triangleOf(first)].nodes;
    otherFrom = nodes[nextCorner(cornerOf(first))];
    const Index otherTo = nodes[previousCorner(cornerOf(first))];
    if ((otherFrom == to && otherTo == from) || (otherFrom == from && otherTo == to))
    {
      break;
    }
  }
  return { first, otherFrom };
}

} // namespace

TriangleTopology::TriangleTopology(const Index* triangles, Index triangleCount, Index nodeCount)
  : triangles_(triangleCount)
  , nodes_(nodeCount)
{
  for (MeshNode& node : this->nodes_)
  {
    ::new (static_cast<void*>(&node)) MeshNode;
  }
  this->build(triangles, nullptr);
}

TriangleTopology::TriangleTopology(const TriangleMeshView& mesh, Threads* threads)
  : triangles_(mesh.triangleCount)
  , nodes_(mesh.nodeCount)
{
  const auto place = [&](const auto* coordinates)
  {
    doInBlocks(threads, this->nodeCount(), kBlock,
      [&](Index begin, Index end)
      {
        const auto* p = coordinates + std::size_t{ 3 } * begin;
        for (Index i = begin; i < end; ++i, p += 3)
        {
          (::new (static_cast<void*>(&this->nodes_[i])) MeshNode)->position = { p[0], p[1], p[2] };
        }
      });
  };
  mesh.pointsDouble ? place(mesh.pointsDouble) : place(mesh.pointsFloat);
  mesh.wideTriangles ? this->build(mesh.wideTriangles, threads)
                     : this->build(mesh.triangles, threads);
}

template <typename Number>
void TriangleTopology::build(const Number* triangles, Threads* threads)
{
  if (threads && threads->count() > 1)
  {
    this->ranges_.resize(this->triangles_.size() / kNodeRangeTriangles + 1);
  }
  const auto fill = [&]
  {
    doInBlocks(threads, this->triangleCount(), kBlock,
      [&](Index begin, Index end)
      {
        const Number* t = triangles + std::size_t{ 3 } * begin;
        for (Index i = begin; i < end; ++i, t += 3)
        {
          this->triangles_[i] = { { static_cast<Index>(t[0]), static_cast<Index>(t[1]),
                                    static_cast<Index>(t[2]) },
            { kNoCorner, kNoCorner, kNoCorner }, kNone, 0 };
        }
        this->findRanges(begin, end);
      });
  };
  fill();
  if (!threads || threads->count() == 1)
  {
    this->connect();
  }
  else if (!this->connect(*threads))
  {
    fill();
    for (MeshNode& node : this->nodes_)
    {
      node.corner = kNoCorner;
    }
    this->connect();
  }
  this->markDegenerate(threads);
  this->markNodes(threads);
}

// Of triangles from the beginning of a range on.
void TriangleTopology::findRanges(Index begin, Index end)
{
  static_assert(kBlock % kNodeRangeTriangles == 0, "a range is one job's");
  for (Index first = begin; first < end && !this->ranges_.empty(); first += kNodeRangeTriangles)
  {
    NodeRange range{ this->nodeCount(), 0 };
    const Index count = std::min(kNodeRangeTriangles, end - first);
    for (Index t = first; t < first + count; ++t)
    {
      for (const Index node : this->triangles_[t].nodes)
      {
        range.lowest = std::min(range.lowest, node);
        range.highest = std::max(range.highest, node);
      }
    }
    this->ranges_[static_cast<std::size_t>(first / kNodeRangeTriangles)] = range;
  }
}

// As many as the ranges allow: one that lies in several shares is visited for each of them.
Index TriangleTopology::sharesPerThread(Index threads) const
{
  const auto visits = [&](Index perThread)
  {
    const Index size = this->nodeCount() / (threads * perThread) + 1;
    std::size_t sum = 0;
    for (const NodeRange& range : this->ranges_)
    {
      sum += static_cast<std::size_t>(range.highest / size - range.lowest / size) + 1;
    }
    return sum;
  };
  const std::size_t most = this->ranges_.size() + this->ranges_.size() / 8;
  Index perThread = this->ranges_.empty() ? 1 : kSharesPerThread;
  while (perThread > 1 && visits(perThread) > most)
  {
    perThread /= 2;
  }
  return perThread;
}

// connect() by several threads, each for the edges whose smaller node is in its share. False if
// there are edges of more than two or of misoriented triangles, which lie in several shares.
bool TriangleTopology::connect(Threads& threads)
{
  LargeArray<Corner, 2> next(std::size_t{ 3 } * this->triangles_.size());
  std::atomic<bool> good{ true };
  this->doInNodeShares(&threads,
    [&](const Share& share)
    {
      if (good && !this->connectShare(share, next))
      {
        good = false;
      }
    });
  return good;
}

bool TriangleTopology::connectShare(const Share& share, LargeArray<Corner, 2>& next)
{
  bool good = true;
  // Local copies: what is written could be theirs.
  Triangle* const triangles = this->triangles_.data();
  MeshNode* const meshNodes = this->nodes_.data();
  const auto behind = [list = next.data()](Corner corner) -> Corner&
  { return list[std::size_t{ 3 } * triangleOf(corner) + cornerOf(corner)]; };
  this->visitTriangles(share,
    [&](Index i, const auto& ours)
    {
      Triangle& t = triangles[i];
      for (int c = 0; c < 3; ++c)
      {
        const Index from = t.nodes[nextCorner(c)];
        const Index to = t.nodes[previousCorner(c)];
        const Index smaller = std::min(from, to);
        if (!ours.has(smaller))
        {
          continue;
        }
        const Corner here = makeCorner(i, c);
        Corner& first = meshNodes[smaller].corner;
        const auto [there, thereFrom] = findListed(triangles, first, behind, from, to);
        if (there == kNoCorner)
        {
          behind(here) = first;
          first = here;
          continue;
        }
        Corner& across = triangles[triangleOf(there)].across[cornerOf(there)];
        if (across != kNoCorner || thereFrom == from)
        {
          good = false;
          continue;
        }
        across = here;
        t.across[c] = there;
      }
    });
  return good;
}

// Find the triangles on either side of each edge. Of each edge the first corner opposite to it is
// listed at the edge's smaller node, which has the head of the list in its `corner`: three corners
// at a node on the average.
void TriangleTopology::connect()
{
  const Index triangleCount = static_cast<Index>(this->triangles_.size());
  LargeArray<Corner, 2> next(std::size_t{ 3 } * triangleCount);
  const auto behind = [&next](Corner corner) -> Corner&
  { return next[std::size_t{ 3 } * triangleOf(corner) + cornerOf(corner)]; };
  bool anyBad = false; // edges that stay open: their bits in Triangle::spare
  for (Index i = 0; i < triangleCount; ++i)
  {
    Triangle& t = this->triangles_[i];
    for (int c = 0; c < 3; ++c)
    {
      const Index from = t.nodes[nextCorner(c)];
      const Index to = t.nodes[previousCorner(c)];
      const Index smaller = std::min(from, to);
      const Corner here = makeCorner(i, c);
      Corner& first = this->nodes_[smaller].corner;
      const auto [there, thereFrom] = findListed(this->triangles_.data(), first, behind, from, to);
      if (there == kNoCorner)
      {
        behind(here) = first;
        first = here;
        continue;
      }
      Triangle& o = this->triangles_[triangleOf(there)];
      Corner& across = o.across[cornerOf(there)];
      const int bad = 1 << cornerOf(there);
      if (across == kNoCorner && (o.spare & bad) == 0 && thereFrom != from)
      {
        across = here;
        t.across[c] = there;
        continue;
      }
      // The third triangle of an edge, or the second that runs along it in the same direction.
      if (across != kNoCorner)
      {
        this->triangles_[triangleOf(across)].across[cornerOf(across)] = kNoCorner;
        across = kNoCorner;
      }
      o.spare |= bad;
      anyBad = true;
      this->nodes_[from].kind = NodeKind::NonManifold;
      this->nodes_[to].kind = NodeKind::NonManifold;
    }
  }
  for (Index i = 0; anyBad && i < triangleCount; ++i)
  {
    this->triangles_[i].spare = 0;
  }
}

// Triangles with a node twice, and triangles that exist twice (in either orientation).
void TriangleTopology::markDegenerate(Threads* threads)
{
  const auto isDegenerate = [](const Triangle& t)
  {
    if (t.nodes[0] == t.nodes[1] || t.nodes[1] == t.nodes[2] || t.nodes[2] == t.nodes[0])
    {
      return true;
    }
    // Two copies share all edges. If each edge has just the two of them they are neighbours; else
    // their edges are non-manifold or misoriented, and their nodes are kept for that.
    for (int c = 0; c < 3; ++c)
    {
      const Corner a = t.across[c];
      const Corner b = t.across[nextCorner(c)];
      if (a != kNoCorner && b != kNoCorner && triangleOf(a) == triangleOf(b))
      {
        return true;
      }
    }
    return false;
  };
  std::mutex mutex; // there are few
  doInShares(threads, this->triangleCount(),
    [&](const Share& share)
    {
      for (Index i = share.begin; i < share.end; ++i)
      {
        if (isDegenerate(this->triangles_[i]))
        {
          const std::lock_guard<std::mutex> lock(mutex);
          for (const Index node : this->triangles_[i].nodes)
          {
            this->nodes_[node].kind = NodeKind::Degenerate;
          }
        }
      }
    });
}

void TriangleTopology::markNodes(Threads* threads)
{
  const Index nodeCount = this->nodeCount();
  // The neighbours, and in the nodes' values twice their triangles, and 1 if a fan's end is here, a
  // boundary edge that leaves the node. Their corners are heads of connect()'s lists until the
  // first triangle is found.
  this->doInNodeShares(threads,
    [&](const auto& share)
    {
      this->visitTriangles(share,
        [&](Index i, const auto& ours)
        {
          const Triangle& t = this->triangles_[i];
          for (int c = 0; c < 3; ++c)
          {
            if (!ours.has(t.nodes[c]))
            {
              continue;
            }
            MeshNode& node = this->nodes_[t.nodes[c]];
            node.neighbours |=
              signature(t.nodes[nextCorner(c)]) | signature(t.nodes[previousCorner(c)]);
            // The first triangle of an open fan has nothing behind its edge node -> next node.
            const bool start = t.across[previousCorner(c)] == kNoCorner;
            if (start || node.value == 0)
            {
              node.corner = makeCorner(i, c);
            }
            node.value = static_cast<std::int32_t>(
              (static_cast<std::uint32_t>(node.value) + 2) | (start ? 1U : 0U));
          }
        });
    });
  const auto mark = [&](MeshNode& node)
  {
    const auto triangles = static_cast<Index>(static_cast<std::uint32_t>(node.value) / 2);
    const bool isOpen = node.value % 2 != 0;
    node.value = 0;
    if (triangles == 0 || node.kind != NodeKind::Unused)
    {
      return;
    }
    // One fan must take in all triangles of the node, else surfaces just touch there.
    Index count = 0;
    const Corner start = node.corner;
    Corner corner = start;
    do
    {
      ++count;
      const Triangle& t = this->triangles_[triangleOf(corner)];
      const Corner opposite = t.across[nextCorner(cornerOf(corner))];
      corner = opposite == kNoCorner
        ? kNoCorner
        : makeCorner(triangleOf(opposite), nextCorner(cornerOf(opposite)));
    } while (corner != kNoCorner && corner != start && count <= triangles);
    node.kind = count != triangles ? NodeKind::NonManifold
      : isOpen                     ? NodeKind::Boundary
                                   : NodeKind::Interior;
  };
  doInBlocks(threads, nodeCount, kBlock,
    [&](Index begin, Index end)
    {
      for (Index node = begin; node < end; ++node)
      {
        mark(this->nodes_[node]);
      }
    });
}

bool TriangleTopology::gather(Index node, Hole& hole) const
{
  Corner corner = this->nodes_[node].corner;
  if (this->nodes_[node].kind == NodeKind::Boundary)
  {
    // Back to the first triangle of the fan.
    for (;;)
    {
      const Triangle& t = this->triangles_[triangleOf(corner)];
      const Corner opposite = t.across[previousCorner(cornerOf(corner))];
      if (opposite == kNoCorner)
      {
        break;
      }
      corner = makeCorner(triangleOf(opposite), previousCorner(cornerOf(opposite)));
    }
  }
  hole.node = node;
  hole.boundary = false;
  int count = 0;
  const Corner start = corner;
  for (;;)
  {
    if (count == kMaximumPatchCells)
    {
      return false;
    }
    const Triangle& t = this->triangles_[triangleOf(corner)];
    const int c = cornerOf(corner);
    hole.corners[count] = corner;
    hole.ring[count] = t.nodes[nextCorner(c)];
    this->prefetchNode(hole.ring[count]); // to be asked for edges
    hole.outer[count] = t.across[c];
    ++count;
    const Corner opposite = t.across[nextCorner(c)];
    if (opposite == kNoCorner)
    {
      hole.boundary = true;
      hole.ring[count] = t.nodes[previousCorner(c)];
      break;
    }
    corner = makeCorner(triangleOf(opposite), nextCorner(cornerOf(opposite)));
    if (corner == start)
    {
      break;
    }
  }
  hole.triangleCount = count;
  hole.size = hole.boundary ? count + 1 : count;
  return true;
}

// Whether a manifold node shares an edge with another one.
bool TriangleTopology::haveEdge(Index a, Index b) const
{
  const Corner start = this->nodes_[a].corner;
  Corner corner = start;
  for (;;)
  {
    const Triangle& t = this->triangles_[triangleOf(corner)];
    const int c = cornerOf(corner);
    if (t.nodes[nextCorner(c)] == b || t.nodes[previousCorner(c)] == b)
    {
      return true;
    }
    const Corner opposite = t.across[nextCorner(c)];
    if (opposite == kNoCorner)
    {
      break;
    }
    corner = makeCorner(triangleOf(opposite), nextCorner(cornerOf(opposite)));
    if (corner == start)
    {
      return false;
    }
  }
  // An open fan that was not entered at its first triangle: the rest lies the other way.
  corner = start;
  for (;;)
  {
    const Triangle& t = this->triangles_[triangleOf(corner)];
    const int c = cornerOf(corner);
    if (t.nodes[nextCorner(c)] == b)
    {
      return true;
    }
    const Corner opposite = t.across[previousCorner(c)];
    if (opposite == kNoCorner)
    {
      return false;
    }
    corner = makeCorner(triangleOf(opposite), previousCorner(cornerOf(opposite)));
  }
}

bool TriangleTopology::findEdge(Index a, Index b) const
{
  if (this->isManifold(a))
  {
    return this->haveEdge(a, b);
  }
  return !this->isManifold(b) || this->haveEdge(b, a);
}

bool TriangleTopology::isClosable(const Hole& hole) const
{
  if (hole.size == 2)
  {
    // A corner with one triangle goes if something is left behind its edge; a closed pair stays.
    return hole.boundary && hole.outer[0] != kNoCorner;
  }
  return hole.boundary ? !this->mayHaveEdge(hole.ring[0], hole.ring[hole.size - 1])
                       : hole.size > 3 || !this->fillsExistingTriangle(hole);
}

// Whether the one triangle that would fill a hole of three nodes exists already.
bool TriangleTopology::fillsExistingTriangle(const Hole& hole) const
{
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    if (hole.outer[i] == kNoCorner)
    {
      // Nothing is there, or triangles that are not connected across this edge: then do not risk
      // it.
      if (!this->isManifold(hole.ring[i]) && !this->isManifold(hole.ring[(i + 1) % hole.size]))
      {
        return true;
      }
      continue;
    }
    const Triangle& t = this->triangles_[triangleOf(hole.outer[i])];
    const Index third = t.nodes[cornerOf(hole.outer[i])];
    if (third == hole.ring[0] || third == hole.ring[1] || third == hole.ring[2])
    {
      return true;
    }
  }
  return false;
}

void TriangleTopology::replace(const Hole& hole, const HoleTriangulation& filling)
{
  this->nodes_[hole.node].kind = NodeKind::Removed;
  const int last = hole.size - 1;
  if (filling.count == 0)
  {
    // A boundary node with one triangle: the triangle behind it gets a boundary edge.
    const Corner outer = hole.outer[0];
    this->triangles_[triangleOf(outer)].across[cornerOf(outer)] = kNoCorner;
    this->nodes_[hole.ring[0]].corner =
      makeCorner(triangleOf(outer), previousCorner(cornerOf(outer)));
    this->nodes_[hole.ring[1]].corner = makeCorner(triangleOf(outer), nextCorner(cornerOf(outer)));
    return;
  }
  // What lies behind the edge from each corner of the polygon that is left to the next one.
  std::array<Corner, kMaximumPatchCells + 1> behind;
  std::copy_n(hole.outer.begin(), hole.triangleCount, behind.begin());
  if (hole.boundary)
  {
    behind[last] = kNoCorner;
    this->meet(hole.ring[0], hole.ring[last]);
  }
  const auto link = [this](Corner here, Corner there)
  {
    if (there != kNoCorner)
    {
      this->triangles_[triangleOf(there)].across[cornerOf(there)] = here;
    }
    return there;
  };
  for (int i = 0;; ++i)
  {
    const auto [previous, ear, next] = filling.triangles[i];
    const Index slot = triangleOf(hole.corners[i]);
    Triangle& t = this->triangles_[slot];
    const Index previousNode = hole.ring[previous];
    const Index nextNode = hole.ring[next];
    t.nodes = { previousNode, hole.ring[ear], nextNode };
    this->nodes_[hole.ring[ear]].corner = makeCorner(slot, 1);
    t.across[0] = link(makeCorner(slot, 0), behind[ear]);
    t.across[2] = link(makeCorner(slot, 2), behind[previous]);
    if (i + 1 == filling.count)
    {
      t.across[1] = link(makeCorner(slot, 1), behind[next]);
      this->nodes_[previousNode].corner = makeCorner(slot, 0);
      this->nodes_[nextNode].corner = makeCorner(slot, 2);
      return;
    }
    behind[previous] = makeCorner(slot, 1);
    this->meet(previousNode, nextNode);
  }
}

} // namespace undecimate
