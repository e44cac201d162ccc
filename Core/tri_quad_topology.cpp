// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tri_quad_topology.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace undecimate
{

namespace
{

Index findRoot(std::vector<Index>& parents, Index i)
{
  while (parents[i] != i)
  {
    parents[i] = parents[parents[i]];
    i = parents[i];
  }
  return i;
}

void unite(std::vector<Index>& parents, Index i, Index j)
{
  const Index a = findRoot(parents, i);
  const Index b = findRoot(parents, j);
  parents[std::max(a, b)] = std::min(a, b);
}

// A cell's nodes in increasing order; kNone comes first.
std::array<Index, kTriQuadCorners> sorted(const Index* cell)
{
  std::array<Index, kTriQuadCorners> nodes{ cell[0], cell[1], cell[2], cell[3] };
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

} // namespace

/// Finds the cells that are no surface, and splits nodes into copies.
class TriQuadBuilder
{
public:
  TriQuadBuilder(TriQuadTopology& topology, const TriQuadMeshView& mesh)
    : topology_(topology)
    , mesh_(mesh)
    , excluded_(mesh.cellCount, false)
  {
  }

  void build()
  {
    TriQuadTopology& t = this->topology_;
    this->excludeDegenerate();
    this->link();
    this->excludeRepeated();
    this->link();
    this->excludeFewNeighbours();
    this->link();
    t.kinds_.assign(t.nodeCount_, TriQuadNodeKind::Unused);
    t.freeEdge_.assign(t.nodeCount_, false);
    this->split();
    this->findBoundary();
    this->findComponents();
    for (Index slot = 0; slot < t.cellCount(); ++slot)
    {
      const Index* cell = this->mesh_.cells + std::size_t{ kTriQuadCorners } * slot;
      for (int k = 0; this->excluded_[slot] && k < kTriQuadCorners; ++k)
      {
        if (cell[k] != kNone)
        {
          t.kinds_[cell[k]] = TriQuadNodeKind::Irregular;
        }
      }
    }
  }

private:
  void excludeDegenerate()
  {
    for (Index slot = 0; slot < this->topology_.cellCount(); ++slot)
    {
      const auto nodes = sorted(this->topology_.cell(slot));
      this->excluded_[slot] =
        std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end() || nodes[1] == kNone;
    }
  }

  // The list of corners of each node, in the order of the cells.
  void link()
  {
    TriQuadTopology& t = this->topology_;
    t.first_.assign(t.nodeCount_, kNoCellCorner);
    for (Index slot = t.cellCount() - 1; slot >= 0; --slot)
    {
      for (int k = kTriQuadCorners - 1; k >= 0 && !this->excluded_[slot]; --k)
      {
        const Index node = t.cell(slot)[k];
        if (node != kNone)
        {
          const CellCorner corner = static_cast<CellCorner>(slot) << 2 | k;
          t.next_[corner] = t.first_[node];
          t.first_[node] = corner;
        }
      }
    }
  }

  // Repeated cells meet in the list of their smallest node.
  void excludeRepeated()
  {
    const TriQuadTopology& t = this->topology_;
    std::vector<std::pair<std::array<Index, kTriQuadCorners>, Index>> cells;
    for (Index node = 0; node < t.nodeCount_; ++node)
    {
      cells.clear();
      for (CellCorner c = t.first_[node]; c != kNoCellCorner; c = t.next_[c])
      {
        const auto nodes = sorted(t.cell(slotOf(c)));
        if (nodes[nodes[0] == kNone ? 1 : 0] == node)
        {
          cells.emplace_back(nodes, slotOf(c));
        }
      }
      std::sort(cells.begin(), cells.end());
      for (std::size_t i = 1; i < cells.size(); ++i)
      {
        if (cells[i].first == cells[i - 1].first)
        {
          this->excluded_[cells[i].second] = true;
          this->excluded_[cells[i - 1].second] = true;
        }
      }
    }
  }

  // Find the fans of a node: fans_[i] is the fan of the i-th cell in its list.
  void findFans(Index node)
  {
    const TriQuadTopology& t = this->topology_;
    this->slots_.clear();
    this->edges_.clear();
    for (CellCorner c = t.first_[node]; c != kNoCellCorner; c = t.next_[c])
    {
      const Index i = static_cast<Index>(this->slots_.size());
      const Index* cell = t.cell(slotOf(c));
      this->edges_.emplace_back(cell[TriQuadTopology::before(cell, placeOf(c))], i);
      this->edges_.emplace_back(cell[TriQuadTopology::behind(cell, placeOf(c))], i);
      this->slots_.push_back(slotOf(c));
    }
    std::sort(this->edges_.begin(), this->edges_.end());
    this->fans_.resize(this->slots_.size());
    std::iota(this->fans_.begin(), this->fans_.end(), Index{ 0 });
    this->links_.assign(this->slots_.size(), 0);
    this->free_ = false;
    for (std::size_t i = 0; i < this->edges_.size();)
    {
      std::size_t end = i + 1;
      while (end < this->edges_.size() && this->edges_[end].first == this->edges_[i].first)
      {
        ++end;
      }
      this->free_ = this->free_ || end - i == 1;
      const Index* parts = this->mesh_.parts;
      const Index a = this->edges_[i].second;
      const Index b = this->edges_[end - 1].second;
      if (end - i == 2 && (!parts || parts[this->slots_[a]] == parts[this->slots_[b]]))
      {
        unite(this->fans_, a, b);
        ++this->links_[a];
        ++this->links_[b];
      }
      i = end;
    }
    for (Index& fan : this->fans_)
    {
      fan = findRoot(this->fans_, fan);
    }
  }

  // M2: a closed fan of two cells.
  void excludeFewNeighbours()
  {
    std::vector<Index> bad;
    for (Index node = 0; node < this->topology_.nodeCount_; ++node)
    {
      this->findFans(node);
      this->sizes_.assign(this->fans_.size(), 0);
      for (std::size_t i = 0; i < this->fans_.size(); ++i)
      {
        ++this->sizes_[this->fans_[i]];
      }
      for (std::size_t i = 0; i < this->fans_.size(); ++i)
      {
        if (this->sizes_[this->fans_[i]] == 2 && this->links_[i] == 2)
        {
          bad.push_back(this->slots_[i]);
        }
      }
    }
    for (const Index slot : bad)
    {
      this->excluded_[slot] = true;
    }
  }

  // One copy for each fan. The lists change at the end, for they are read on the way.
  void split()
  {
    TriQuadTopology& t = this->topology_;
    std::vector<std::pair<CellCorner, Index>> moved;
    for (Index node = 0; node < t.nodeCount_; ++node)
    {
      if (t.first_[node] == kNoCellCorner)
      {
        continue;
      }
      this->findFans(node);
      t.freeEdge_[node] = this->free_;
      const bool one =
        std::all_of(this->fans_.begin(), this->fans_.end(), [](Index fan) { return fan == 0; });
      t.kinds_[node] = one ? TriQuadNodeKind::Interior : TriQuadNodeKind::Seam;
      if (one)
      {
        continue;
      }
      // A root is the first cell of its fan; the first fan keeps the node's number.
      std::vector<Index> copies(this->fans_.size(), kNone);
      copies[0] = node;
      Index last = node;
      CellCorner corner = t.first_[node];
      for (std::size_t i = 0; i < this->fans_.size(); ++i, corner = t.next_[corner])
      {
        Index& copy = copies[this->fans_[i]];
        if (copy == kNone)
        {
          copy = t.nodeCount_ + static_cast<Index>(t.extraNodes_.size());
          t.extraNodes_.push_back(node);
          this->pairs_.emplace_back(last, copy);
          last = copy;
        }
        if (copy != node)
        {
          moved.emplace_back(corner, copy);
        }
      }
    }
    if (t.extraNodes_.empty())
    {
      return;
    }
    const Index copyCount = t.nodeCount_ + static_cast<Index>(t.extraNodes_.size());
    t.nextCopies_.assign(copyCount, kNone);
    for (const auto& [copy, next] : this->pairs_)
    {
      t.nextCopies_[copy] = next;
    }
    t.first_.resize(copyCount, kNoCellCorner);
    for (auto m = moved.rbegin(); m != moved.rend(); ++m)
    {
      const auto [corner, copy] = *m;
      t.unlink(t.cell(slotOf(corner))[placeOf(corner)], corner);
      t.cellAt(slotOf(corner))[placeOf(corner)] = copy;
      t.next_[corner] = t.first_[copy];
      t.first_[copy] = corner;
    }
  }

  void findBoundary()
  {
    TriQuadTopology& t = this->topology_;
    t.boundary_.assign(t.copyCount(), false);
    std::vector<Index> neighbours;
    for (Index copy = 0; copy < t.copyCount(); ++copy)
    {
      neighbours.clear();
      for (CellCorner c = t.first_[copy]; c != kNoCellCorner; c = t.next_[c])
      {
        const Index* cell = t.cell(slotOf(c));
        neighbours.push_back(cell[TriQuadTopology::before(cell, placeOf(c))]);
        neighbours.push_back(cell[TriQuadTopology::behind(cell, placeOf(c))]);
      }
      // In a closed fan each neighbour comes twice.
      std::sort(neighbours.begin(), neighbours.end());
      for (std::size_t i = 0; i < neighbours.size(); i += 2)
      {
        if (i + 1 == neighbours.size() || neighbours[i] != neighbours[i + 1])
        {
          t.boundary_[copy] = true;
          break;
        }
      }
      if (t.boundary_[copy] && t.kinds_[t.nodeOf(copy)] == TriQuadNodeKind::Interior)
      {
        t.kinds_[t.nodeOf(copy)] = TriQuadNodeKind::Boundary;
      }
    }
  }

  void findComponents()
  {
    TriQuadTopology& t = this->topology_;
    t.component_.resize(t.copyCount());
    std::iota(t.component_.begin(), t.component_.end(), Index{ 0 });
    for (Index slot = 0; slot < t.cellCount(); ++slot)
    {
      const Index* cell = t.cell(slot);
      const Index any = cell[0] != kNone ? cell[0] : cell[1];
      for (int k = 1; k < kTriQuadCorners && !this->excluded_[slot]; ++k)
      {
        if (cell[k] != kNone)
        {
          unite(t.component_, any, cell[k]);
        }
      }
    }
    t.componentNodes_.assign(t.copyCount(), 0);
    for (Index copy = 0; copy < t.copyCount(); ++copy)
    {
      t.component_[copy] = findRoot(t.component_, copy);
      ++t.componentNodes_[t.component_[copy]];
    }
  }

  TriQuadTopology& topology_;
  const TriQuadMeshView& mesh_;
  std::vector<bool> excluded_;
  std::vector<std::pair<Index, Index>> pairs_; // a copy and the next one of the same node
  // Of the node at hand.
  std::vector<Index> slots_;
  std::vector<std::pair<Index, Index>> edges_; // neighbour, position in slots_
  std::vector<Index> fans_;
  std::vector<Index> sizes_;         // of fans, by root
  std::vector<unsigned char> links_; // edges of the cell at which its fan goes on
  bool free_ = false;
};

TriQuadTopology::TriQuadTopology(const TriQuadMeshView& mesh, const CollapseRules& rules)
  : rules_(rules)
  , nodeCount_(static_cast<Index>(mesh.nodeCount))
  , cells_(mesh.cells, mesh.cells + kTriQuadCorners * mesh.cellCount)
  , next_(kTriQuadCorners * mesh.cellCount, kNoCellCorner)
{
  TriQuadBuilder(*this, mesh).build();
}

std::vector<Index> TriQuadTopology::takeCells()
{
  std::vector<Index> cells(this->cells_.size(), kNone);
  for (std::size_t i = 0; i < cells.size(); i += kTriQuadCorners)
  {
    int place = 0;
    for (int k = 0; k < kTriQuadCorners; ++k)
    {
      if (this->cells_[i + k] != kNone)
      {
        cells[i + place++] = this->nodeOf(this->cells_[i + k]);
      }
    }
  }
  *this = TriQuadTopology({});
  return cells;
}

// Places of the corners beside one, in a triangle past its empty place.
int TriQuadTopology::before(const Index* cell, int place)
{
  const int k = (place + 3) & 3;
  return cell[k] != kNone ? k : (place + 2) & 3;
}

int TriQuadTopology::behind(const Index* cell, int place)
{
  const int k = (place + 1) & 3;
  return cell[k] != kNone ? k : (place + 2) & 3;
}

bool TriQuadTopology::gather(Index copy, Fan& fan) const
{
  fan.copy = copy;
  fan.boundary = this->boundary_[copy];
  fan.cellCount = 0;
  fan.neighbourCount = 0;
  for (CellCorner c = this->first_[copy]; c != kNoCellCorner; c = this->next_[c])
  {
    if (fan.cellCount == kMaximumPatchCells)
    {
      return false;
    }
    fan.corners[fan.cellCount++] = c;
    const Index* cell = this->cell(slotOf(c));
    for (const int place : { before(cell, placeOf(c)), behind(cell, placeOf(c)) })
    {
      int i = 0;
      while (i < fan.neighbourCount && fan.neighbours[i] != cell[place])
      {
        ++i;
      }
      if (i == fan.neighbourCount)
      {
        fan.neighbours[fan.neighbourCount] = cell[place];
        fan.edgeCells[fan.neighbourCount++] = 0;
      }
      ++fan.edgeCells[i];
    }
  }
  return true;
}

bool TriQuadTopology::mayCollapse(const Fan& fan, Index target) const
{
  const auto* end = fan.neighbours.begin() + fan.neighbourCount;
  const auto* found = std::find(fan.neighbours.begin(), end, target);
  if (found == end)
  {
    return false;
  }
  const bool boundaryEdge = fan.edgeCells[found - fan.neighbours.begin()] == 1;
  const bool toBoundary = this->boundary_[target];
  if (fan.boundary && !toBoundary)
  {
    return false;
  }
  if (this->rules_.boundaryEdge && fan.boundary && toBoundary && !boundaryEdge)
  {
    return false;
  }
  // The other copies of the node go as well.
  const Index component = this->component_[fan.copy];
  Index going = 0;
  for (Index copy = this->nodeOf(fan.copy); copy != kNone; copy = this->nextCopy(copy))
  {
    going += this->component_[copy] == component;
  }
  const Index fewest = fan.boundary || toBoundary ? 3 : 4;
  if (this->rules_.lastNodes && this->componentNodes_[component] - going < fewest)
  {
    return false;
  }
  // Nodes with more cells than a step can have would never go.
  if (fan.cellCount + this->countCells(target) > kMaximumPatchCells)
  {
    return false;
  }
  return this->keepsNeighbourRule(fan, target) && this->keepsSheetsApart(fan, target);
}

// P1*, or what is in its place.
bool TriQuadTopology::keepsNeighbourRule(const Fan& fan, Index target) const
{
  if (this->rules_.neighbours == NeighbourRule::None)
  {
    return true;
  }
  const bool second = this->rules_.neighbours == NeighbourRule::SecondOrder;
  std::array<Index, 2 * kMaximumPatchCells> shared; // nodes of cells with both
  int sharedCount = 0;
  std::array<Index, 3 * kMaximumPatchCells> near; // nodes of cells with the node
  int nearCount = 0;
  std::uint64_t bits = 0; // of the lowest digits of those: most others have none of them
  const auto bitOf = [](Index copy) { return std::uint64_t{ 1 } << (copy & 63); };
  const auto isNear = [&](Index copy)
  {
    const auto* end = near.begin() + nearCount;
    return (bits & bitOf(copy)) != 0 && std::find(near.cbegin(), end, copy) != end;
  };
  for (int i = 0; i < fan.cellCount; ++i)
  {
    const Index* cell = this->cell(slotOf(fan.corners[i]));
    const int place = placeOf(fan.corners[i]);
    const int beside[] = { before(cell, place), behind(cell, place) };
    const bool both = std::find(cell, cell + kTriQuadCorners, target) != cell + kTriQuadCorners;
    for (int k = 0; k < kTriQuadCorners; ++k)
    {
      if (k == place || cell[k] == kNone || cell[k] == target)
      {
        continue;
      }
      if ((second || k == beside[0] || k == beside[1]) && !isNear(cell[k]))
      {
        near[nearCount++] = cell[k];
        bits |= bitOf(cell[k]);
      }
      if (both)
      {
        shared[sharedCount++] = cell[k];
      }
    }
  }
  for (CellCorner c = this->first_[target]; c != kNoCellCorner; c = this->next_[c])
  {
    const Index* cell = this->cell(slotOf(c));
    const int place = placeOf(c);
    const int beside[] = { before(cell, place), behind(cell, place) };
    for (int k = 0; k < kTriQuadCorners; ++k)
    {
      if (k != place && cell[k] != kNone && cell[k] != fan.copy &&
        (second || k == beside[0] || k == beside[1]) && isNear(cell[k]) &&
        std::find(shared.begin(), shared.begin() + sharedCount, cell[k]) ==
          shared.begin() + sharedCount)
      {
        return false;
      }
    }
  }
  return true;
}

// Whether the new edges and cells stay apart from those of other sheets: no cell gets two copies of
// a node, or the nodes of a cell of another sheet, and no edge of two seam nodes is another
// sheet's.
bool TriQuadTopology::keepsSheetsApart(const Fan& fan, Index target) const
{
  const Index node = this->nodeOf(target);
  if (this->nextCopy(node) == kNone)
  {
    return true;
  }
  for (int i = 0; i < fan.cellCount; ++i)
  {
    const Index* cell = this->cell(slotOf(fan.corners[i]));
    for (int k = 0; k < kTriQuadCorners; ++k)
    {
      if (cell[k] != kNone && cell[k] != target && this->nodeOf(cell[k]) == node)
      {
        return false;
      }
    }
    if (this->hasTwin(fan, i, target))
    {
      return false;
    }
  }
  for (int i = 0; i < fan.neighbourCount; ++i)
  {
    const Index other = this->nodeOf(fan.neighbours[i]);
    if (fan.neighbours[i] == target || this->nextCopy(other) == kNone ||
      this->hasEdge(target, fan.neighbours[i]))
    {
      continue;
    }
    // Along a seam all sheets that have the node get the same new edge. One may have it already,
    // with a triangle of the node that vanishes: P1* has seen to that.
    const bool alongSeam = fan.boundary && fan.edgeCells[i] == 1;
    for (Index copy = node; copy != kNone; copy = this->nextCopy(copy))
    {
      if (copy != target && this->hasEdgeToNode(copy, other) &&
        !(alongSeam && this->hasEdgeToNode(copy, this->nodeOf(fan.copy))))
      {
        return false;
      }
    }
  }
  return true;
}

// Whether cell i of the fan will have the same nodes as a cell at another copy of the target.
bool TriQuadTopology::hasTwin(const Fan& fan, int i, Index target) const
{
  const auto nodesOf = [this](const Index* cell)
  {
    std::array<Index, kTriQuadCorners> nodes;
    std::transform(cell, cell + kTriQuadCorners, nodes.begin(),
      [this](Index copy) { return copy == kNone ? kNone : this->nodeOf(copy); });
    return sorted(nodes.data());
  };
  std::array<Index, kTriQuadCorners> changed;
  const Index* cell = this->cell(slotOf(fan.corners[i]));
  std::copy_n(cell, kTriQuadCorners, changed.begin());
  const bool both = std::find(changed.begin(), changed.end(), target) != changed.end();
  changed[placeOf(fan.corners[i])] = both ? kNone : target;
  const auto nodes = nodesOf(changed.data());
  for (Index copy = this->nodeOf(target); copy != kNone; copy = this->nextCopy(copy))
  {
    for (CellCorner c = copy == target ? kNoCellCorner : this->first_[copy]; c != kNoCellCorner;
         c = this->next_[c])
    {
      if (nodesOf(this->cell(slotOf(c))) == nodes)
      {
        return true;
      }
    }
  }
  return false;
}

bool TriQuadTopology::hasEdge(Index copy, Index other) const
{
  for (CellCorner c = this->first_[copy]; c != kNoCellCorner; c = this->next_[c])
  {
    const Index* cell = this->cell(slotOf(c));
    if (cell[before(cell, placeOf(c))] == other || cell[behind(cell, placeOf(c))] == other)
    {
      return true;
    }
  }
  return false;
}

Index TriQuadTopology::cellAcross(Index copy, Index other, Index slot) const
{
  for (CellCorner c = this->first_[copy]; c != kNoCellCorner; c = this->next_[c])
  {
    const Index* cell = this->cell(slotOf(c));
    if (slotOf(c) != slot &&
      (cell[before(cell, placeOf(c))] == other || cell[behind(cell, placeOf(c))] == other))
    {
      return slotOf(c);
    }
  }
  return kNone;
}

bool TriQuadTopology::hasEdgeToNode(Index copy, Index node) const
{
  for (Index other = node; other != kNone; other = this->nextCopy(other))
  {
    if (this->hasEdge(copy, other))
    {
      return true;
    }
  }
  return false;
}

int TriQuadTopology::countCells(Index copy) const
{
  int count = 0;
  for (CellCorner c = this->first_[copy]; c != kNoCellCorner && count <= kMaximumPatchCells;
       c = this->next_[c])
  {
    ++count;
  }
  return count;
}

// Take a corner out of a copy's list.
void TriQuadTopology::unlink(Index copy, CellCorner corner)
{
  CellCorner* link = &this->first_[copy];
  while (*link != corner)
  {
    link = &this->next_[*link];
  }
  *link = this->next_[corner];
}

void TriQuadTopology::collapse(const Fan& fan, Index target)
{
  for (int i = 0; i < fan.cellCount; ++i)
  {
    const CellCorner corner = fan.corners[i];
    const Index slot = slotOf(corner);
    Index* cell = this->cellAt(slot);
    const bool both = std::find(cell, cell + kTriQuadCorners, target) != cell + kTriQuadCorners;
    if (!both)
    {
      cell[placeOf(corner)] = target;
      this->next_[corner] = this->first_[target];
      this->first_[target] = corner;
      continue;
    }
    const bool vanishes = std::find(cell, cell + kTriQuadCorners, kNone) != cell + kTriQuadCorners;
    cell[placeOf(corner)] = kNone;
    for (int k = 0; k < kTriQuadCorners && vanishes; ++k)
    {
      if (cell[k] != kNone)
      {
        this->unlink(cell[k], static_cast<CellCorner>(slot) << 2 | static_cast<CellCorner>(k));
        cell[k] = kNone;
      }
    }
  }
  this->first_[fan.copy] = kNoCellCorner;
  --this->componentNodes_[this->component_[fan.copy]];
}

} // namespace undecimate
