// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file hash_queue.h
/// @brief The hash queue: intervals of evaluation values, first in first out within each.
///
/// Source: [K03] section 1.2, eq. 1-3 and fig. 3.

#ifndef UNDECIMATE_CORE_HASH_QUEUE_H
#define UNDECIMATE_CORE_HASH_QUEUE_H

#include "large_array.h"
#include "types.h"

#include <cstring>
#include <vector>

namespace undecimate
{

/// How the bounds of the intervals are spaced.
enum class IntervalSpacing
{
  /// The leading bits of the value as a float are its interval (exponent and 7 bits of the
  /// fraction): a fixed relative precision of 0.8 % over all magnitudes, no bounds needed.
  Logarithmic,
  /// [K03] eq. 1-3 on normalised values (divided by the largest one).
  Exponential
};

/// Bounds of the intervals by [K03] eq. 1-3.
///
/// With s = e_min + e_max, D = e_max - e_min, L = e_max / ln(1 + D) and m intervals:
///   d_j = s - L ln(1 + D - j D / m),              0 <= j <= m       (eq. 2)
///   j(e) = floor((1 + D - exp((s - e) / L)) m / D), e < e_max       (eq. 3)
///   j(e) = m - 1,                                 e >= e_max
/// The formula is not invariant to units, so the values are divided by e_max first. All values
/// equal (D = 0): one interval. Values below e_min fall into interval 0, values at or above e_max
/// and NaN into the last one.
class ExponentialIntervals
{
public:
  /// @param smallest, largest of the values to be queued, finite, 0 <= smallest <= largest
  /// @param count m >= 1
  ExponentialIntervals(double smallest, double largest, Index count);

  Index count() const { return this->count_; }

  /// Lower bound d_j of interval j in [0, count] (units of the values).
  double bound(Index j) const;

  /// Interval of a value. O(1).
  Index interval(double value) const;

private:
  double scale_;  // 1 / e_max: normalises
  double sum_;    // e_sum, normalised
  double delta_;  // D, normalised
  double length_; // L, normalised
  Index count_;
};

/// A priority queue of nodes that is exact to the width of an interval, with all operations in
/// O(1).
///
/// The next node is the first of the lowest non-empty interval; within an interval nodes leave in
/// the order in which they came, which spreads the removals over the mesh ([K03] 1.2). Doubly
/// linked lists in flat arrays, and a four-level bit set that finds the lowest non-empty interval.
///
/// Memory: 12 bytes a node and 8 bytes an interval.
class HashQueue
{
public:
  /// Room for nodes 0 .. nodeCount - 1 in `intervalCount` intervals (1 .. 2^24). Empty.
  HashQueue(Index nodeCount, Index intervalCount);

  Index intervalCount() const { return this->intervalCount_; }

  /// Nodes in the queue.
  Index size() const { return this->size_; }
  bool empty() const { return this->size_ == 0; }
  bool contains(Index node) const { return this->links_[node].interval != kNone; }

  /// Interval of a node, kNone if it is not in the queue.
  Index interval(Index node) const { return this->links_[node].interval; }

  /// Put a node at the end of an interval; if it is in the queue already it leaves its place.
  void insert(Index node, Index interval);

  /// Take a node out; nothing happens if it is not in.
  void remove(Index node);

  /// Lowest non-empty interval, kNone if empty.
  Index lowestInterval() const;

  /// First node of the lowest non-empty interval, kNone if empty; it stays in.
  Index front() const;

  /// The node behind another one in its interval, kNone if it is the last.
  Index after(Index node) const { return this->links_[node].next; }

  /// The node that leaves behind another one if the queue stays as it is, kNone if there is none.
  Index upcoming(Index node) const
  {
    const Links& links = this->links_[node];
    if (links.next != kNone)
    {
      return links.next;
    }
    const Index interval = this->nextInterval(links.interval);
    return interval == kNone ? kNone : this->ends_[interval].first;
  }

  void prefetch(Index node) const { __builtin_prefetch(&this->links_[node]); }

  /// front(), taken out.
  Index pop();

private:
  void mark(Index interval);
  void unmark(Index interval);
  Index nextInterval(Index interval) const;

  struct Links
  {
    Index next = kNone;
    Index previous = kNone;
    Index interval = kNone;
  };
  struct Ends
  {
    Index first;
    Index last;
  };
  LargeArray<Links, 3> links_;
  std::vector<Ends> ends_;
  std::vector<std::uint64_t> bits_[4]; // bits_[0]: a bit an interval; above: a bit a non-zero word
  Index intervalCount_;
  Index size_ = 0;
};

/// Number of intervals of IntervalSpacing::Logarithmic.
constexpr Index kLogarithmicIntervals = 256 << 7;

/// Interval of a value >= 0 with logarithmic spacing; negative values count as 0, NaN as the
/// largest.
inline Index logarithmicInterval(float value)
{
  if (value != value)
  {
    return kLogarithmicIntervals - 1;
  }
  if (!(value > 0.0F))
  {
    return 0;
  }
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return static_cast<Index>(bits >> 16);
}

inline void HashQueue::insert(Index node, Index interval)
{
  this->remove(node);
  Ends& ends = this->ends_[interval];
  this->links_[node] = { kNone, ends.last, interval };
  if (ends.last == kNone)
  {
    ends.first = node;
    this->mark(interval);
  }
  else
  {
    this->links_[ends.last].next = node;
  }
  ends.last = node;
  ++this->size_;
}

inline void HashQueue::remove(Index node)
{
  Links& links = this->links_[node];
  const Index interval = links.interval;
  if (interval == kNone)
  {
    return;
  }
  const Index next = links.next;
  const Index previous = links.previous;
  links.interval = kNone;
  Ends& ends = this->ends_[interval];
  (previous == kNone ? ends.first : this->links_[previous].next) = next;
  (next == kNone ? ends.last : this->links_[next].previous) = previous;
  if (ends.first == kNone)
  {
    this->unmark(interval);
  }
  --this->size_;
}

inline Index HashQueue::lowestInterval() const
{
  if (this->size_ == 0)
  {
    return kNone;
  }
  Index interval = 0;
  for (int level = 3; level >= 0; --level)
  {
    const std::uint64_t word = this->bits_[level][interval];
    interval = (interval << 6) + __builtin_ctzll(word);
  }
  return interval;
}

inline Index HashQueue::front() const
{
  const Index interval = this->lowestInterval();
  return interval == kNone ? kNone : this->ends_[interval].first;
}

} // namespace undecimate

#endif
