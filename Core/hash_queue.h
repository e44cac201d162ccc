// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file hash_queue.h
/// @brief The hash queue: intervals of evaluation values, first in first out within each.
///
/// Source: [K03] section 1.2, eq. 1-3 and fig. 3.

#ifndef UNDECIMATE_CORE_HASH_QUEUE_H
#define UNDECIMATE_CORE_HASH_QUEUE_H

#include "compiler.h"
#include "large_array.h"
#include "types.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace undecimate
{

/// How the bounds of the intervals are spaced.
enum class IntervalSpacing
{
  /// The leading bits of the value as a float are its interval (exponent and 7 bits of the
  /// fraction): a fixed relative precision of 0.8 % from 2^-48 to 2^16, no bounds needed.
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

/// A bit for each interval that is not empty, and a bit for each word of bits that is not zero:
/// four levels find the lowest interval in four steps.
class IntervalBits
{
public:
  explicit IntervalBits(Index intervalCount);

  void mark(Index interval);
  void unmark(Index interval);

  /// The lowest interval that is marked; there must be one.
  Index lowest() const;

  /// The lowest marked interval above another one, kNone if there is none.
  Index above(Index interval) const;

private:
  static constexpr int kLevels = 4;
  LargeArray<std::uint64_t> bits_[kLevels];
};

/// Place of a node in the queue.
struct QueueLinks
{
  Index next = kNone;
  Index previous = kNone;
  Index interval = kNone; ///< kNone: not in the queue
};

/// A priority queue of nodes that is exact to the width of an interval, with all operations in
/// O(1).
///
/// The next node is the first of the lowest non-empty interval; within an interval nodes leave in
/// the order in which they came, which spreads the removals over the mesh ([K03] 1.2). Doubly
/// linked lists, and IntervalBits that find the lowest non-empty interval.
///
/// @tparam LinksOf QueueLinks& operator()(Index node) const: where the links of a node are stored;
/// at first none is in the queue
/// Memory: 12 bytes a node, in the links, and 8 bytes an interval.
template <typename LinksOf>
class HashQueueOn
{
public:
  /// An empty queue of `intervalCount` intervals (1 .. 2^24).
  HashQueueOn(LinksOf linksOf, Index intervalCount)
    : linksOf_(std::move(linksOf))
    , ends_(std::max<Index>(1, intervalCount), Ends{ kNone, kNone })
    , bits_(this->intervalCount())
  {
  }

  Index intervalCount() const { return static_cast<Index>(this->ends_.size()); }

  /// Nodes in the queue.
  Index size() const { return this->size_; }
  bool empty() const { return this->size_ == 0; }
  bool contains(Index node) const { return this->linksOf_(node).interval != kNone; }

  /// Interval of a node, kNone if it is not in the queue.
  Index interval(Index node) const { return this->linksOf_(node).interval; }

  /// Put a node at the end of an interval; if it is in the queue already it leaves its place.
  void insert(Index node, Index interval)
  {
    this->remove(node);
    Ends& ends = this->ends_[interval];
    this->linksOf_(node) = { kNone, ends.last, interval };
    if (ends.last == kNone)
    {
      ends.first = node;
      this->bits_.mark(interval);
    }
    else
    {
      this->linksOf_(ends.last).next = node;
    }
    ends.last = node;
    ++this->size_;
  }

  /// Take a node out; nothing happens if it is not in.
  void remove(Index node)
  {
    QueueLinks& links = this->linksOf_(node);
    const Index interval = links.interval;
    if (interval == kNone)
    {
      return;
    }
    const Index next = links.next;
    const Index previous = links.previous;
    links.interval = kNone;
    Ends& ends = this->ends_[interval];
    (previous == kNone ? ends.first : this->linksOf_(previous).next) = next;
    (next == kNone ? ends.last : this->linksOf_(next).previous) = previous;
    if (ends.first == kNone)
    {
      this->bits_.unmark(interval);
    }
    --this->size_;
  }

  /// Lowest non-empty interval, kNone if empty.
  Index lowestInterval() const { return this->size_ == 0 ? kNone : this->bits_.lowest(); }

  /// First node of the lowest non-empty interval, kNone if empty; it stays in.
  Index front() const { return this->size_ == 0 ? kNone : this->ends_[this->bits_.lowest()].first; }

  /// The node behind another one in its interval, kNone if it is the last.
  Index after(Index node) const { return this->linksOf_(node).next; }

  /// The node that leaves behind another one if the queue stays as it is, kNone if there is none.
  Index upcoming(Index node) const
  {
    const QueueLinks& links = this->linksOf_(node);
    if (links.next != kNone)
    {
      return links.next;
    }
    const Index interval = this->bits_.above(links.interval);
    return interval == kNone ? kNone : this->ends_[interval].first;
  }

  /// Ask for what taking a node out reads, and for what inserting one at the end of an interval
  /// reads.
  void prefetchRemove(Index node) const
  {
    const QueueLinks& links = this->linksOf_(node);
    if (links.interval != kNone)
    {
      this->prefetchLinks(links.next);
      this->prefetchLinks(links.previous);
    }
  }
  void prefetchInsert(Index interval) const { this->prefetchLinks(this->ends_[interval].last); }

  /// front(), taken out.
  Index pop()
  {
    const Index node = this->front();
    if (node != kNone)
    {
      this->remove(node);
    }
    return node;
  }

private:
  struct Ends
  {
    Index first;
    Index last;
  };
  void prefetchLinks(Index node) const
  {
    if (node != kNone)
    {
      prefetch(&this->linksOf_(node));
    }
  }

  LinksOf linksOf_;
  LargeArray<Ends> ends_;
  IntervalBits bits_;
  Index size_ = 0;
};

/// Links in an array of their own.
class LinksArray
{
public:
  explicit LinksArray(Index nodeCount)
    : links_(nodeCount)
  {
  }
  QueueLinks& operator()(Index node) { return this->links_[node]; }
  const QueueLinks& operator()(Index node) const { return this->links_[node]; }

private:
  LargeArray<QueueLinks, 3> links_;
};

/// The hash queue by itself.
class HashQueue : public HashQueueOn<LinksArray>
{
public:
  /// Room for nodes 0 .. nodeCount - 1 in `intervalCount` intervals (1 .. 2^24). Empty.
  HashQueue(Index nodeCount, Index intervalCount)
    : HashQueueOn(LinksArray(nodeCount), intervalCount)
  {
  }
};

/// Number of intervals of IntervalSpacing::Logarithmic.
constexpr Index kLogarithmicIntervals = 64 << 7;

/// Interval of a value >= 0 with logarithmic spacing. What is less than 2^-48 (negative, too),
/// which for a fraction of a length is rounding, is in the first one; what is 2^16 or more, and
/// NaN, in the last one.
inline Index logarithmicInterval(float value)
{
  constexpr Index kFirst = (127 - 48) << 7; // leading bits of 2^-48
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
  return std::clamp(
    static_cast<Index>(bits >> 16) - kFirst, Index{ 0 }, Index{ kLogarithmicIntervals - 1 });
}

inline void IntervalBits::mark(Index interval)
{
  for (auto& level : this->bits_)
  {
    std::uint64_t& word = level[interval >> 6];
    const bool known = word != 0;
    word |= std::uint64_t{ 1 } << (interval & 63);
    if (known)
    {
      return;
    }
    interval >>= 6;
  }
}

inline void IntervalBits::unmark(Index interval)
{
  for (auto& level : this->bits_)
  {
    std::uint64_t& word = level[interval >> 6];
    word &= ~(std::uint64_t{ 1 } << (interval & 63));
    if (word != 0)
    {
      return;
    }
    interval >>= 6;
  }
}

inline Index IntervalBits::lowest() const
{
  Index interval = 0;
  for (int level = kLevels - 1; level >= 0; --level)
  {
    interval = (interval << 6) + lowestBit(this->bits_[level][interval]);
  }
  return interval;
}

} // namespace undecimate

#endif
