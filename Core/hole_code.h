// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file hole_code.h
/// @brief The removal of a node from triangles in a few bits: how the record keeps it.
///
/// A step of node removal is a hole and the ears that filled it, and nothing else: the *ring* of r
/// nodes around the node, old triangle i with the ring's nodes i and i + 1, and new triangles, each
/// an ear of what the ones before have left of the ring's polygon. With n old triangles there are
/// n - 2 new ones and r = n in the interior, n - 1 new ones and r = n + 1 at the boundary, where
/// the ring is open.
///
/// A step has a byte, the *hole*: n, plus kOpenHole at the boundary. Its code are these bits, from
/// the lowest bit of the first byte upwards, filled up to whole bytes:
///   2 bits for each old triangle      corner (0, 1, 2) at which it has the node
///   w bits for each new triangle      the ear, a place in the ring, that it cuts off
///   w bits for each new triangle      with sources: the old triangle whose values it shows
///   b bits for each new triangle      its slot, in record order
///   b bits for each listed node       the two nodes of a triangle that leaves nothing
/// w is the number of bits of r - 1, b that of the record's numbers (RecordView::numberBits). New
/// triangle i has the ring's nodes before, at and behind its ear, in this order, in the slot of old
/// triangle i. The other old triangles have the slots behind the end of the coarser level.
///
/// Memory: 1 + (2 n + (w + b) (n - 2)) / 8 bytes a step; with two million triangles 12 to 15 with
/// five or six neighbours, 29 with ten.

#ifndef UNDECIMATE_CORE_HOLE_CODE_H
#define UNDECIMATE_CORE_HOLE_CODE_H

#include "compiler.h"
#include "packed_numbers.h"
#include "record.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace undecimate
{

/// Most nodes around a hole.
constexpr int kMaximumPolygon = kMaximumPatchCells + 1;

/// In the byte of a hole: its node is on the boundary.
constexpr unsigned char kOpenHole = 128;

/// Sizes of a hole.
struct HoleCounts
{
  unsigned char oldCount = 0; ///< 0: there is no such hole, and the rest is 0, too
  unsigned char newCount = 0;
  unsigned char ringSize = 0;
  unsigned char extra = 0;     ///< listed nodes: of a triangle that leaves nothing behind
  unsigned char placeBits = 0; ///< w
  short formBits[2] = {};      ///< bits before the slots, without and with sources

  constexpr HoleCounts() = default;

  /// @param hole the byte; all values are sound
  constexpr explicit HoleCounts(unsigned char hole)
  {
    const bool boundary = (hole & kOpenHole) != 0;
    const int n = hole & (kOpenHole - 1);
    if (n < (boundary ? 1 : 3) || n > kMaximumPatchCells)
    {
      return;
    }
    this->oldCount = static_cast<unsigned char>(n);
    this->newCount = static_cast<unsigned char>(boundary ? n - 1 : n - 2);
    this->ringSize = static_cast<unsigned char>(boundary ? n + 1 : n);
    this->extra = this->newCount == 0 ? 2 : 0;
    for (int bits = 1; this->placeBits == 0; ++bits)
    {
      this->placeBits = static_cast<unsigned char>(this->ringSize <= 1 << bits ? bits : 0);
    }
    for (int parts = 1; parts <= 2; ++parts)
    {
      this->formBits[parts - 1] =
        static_cast<short>(2 * n + parts * this->newCount * this->placeBits);
    }
  }

  /// Bytes of the code.
  /// @param numberBits b
  int codeSize(bool hasSources, int numberBits) const
  {
    return (this->formBits[hasSources ? 1 : 0] + numberBits * (this->newCount + this->extra) + 7) /
      8;
  }
};

/// The sizes of all holes, made once.
class HoleTable
{
public:
  constexpr HoleTable()
  {
    for (int hole = 0; hole < 256; ++hole)
    {
      this->counts_[hole] = HoleCounts(static_cast<unsigned char>(hole));
    }
  }
  const HoleCounts& operator[](unsigned char hole) const { return this->counts_[hole]; }

private:
  std::array<HoleCounts, 256> counts_{};
};
inline constexpr HoleTable kHoles;

/// The byte of a hole.
inline unsigned char holeOf(int oldCount, bool boundary)
{
  return static_cast<unsigned char>(oldCount | (boundary ? kOpenHole : 0));
}

/// Places in a polygon while ears are cut off.
class EarCutPolygon
{
  using Neighbours = std::array<unsigned char, kMaximumPolygon>;

  template <int Distance>
  struct At
  {
    Neighbours places{};
    constexpr At()
    {
      for (int i = 0; i < kMaximumPolygon; ++i)
      {
        this->places[i] = static_cast<unsigned char>(i + Distance);
      }
    }
  };

public:
  explicit EarCutPolygon(int size)
  {
    static constexpr At<1> kNext;
    static constexpr At<-1> kPrevious;
    constexpr int kFew = 16; // most polygons: a copy of known size
    std::memcpy(this->next_.data(), kNext.places.data(), kFew);
    std::memcpy(this->previous_.data(), kPrevious.places.data(), kFew);
    if (size > kFew)
    {
      this->next_ = kNext.places;
      this->previous_ = kPrevious.places;
    }
    this->next_[size - 1] = 0;
    this->previous_[0] = static_cast<unsigned char>(size - 1);
  }

  /// Visit(before, ear, behind), and the ear is gone.
  template <typename Visit>
  void cut(int ear, Visit&& visit)
  {
    const unsigned char before = this->previous_[ear];
    const unsigned char behind = this->next_[ear];
    visit(before, static_cast<unsigned char>(ear), behind);
    this->next_[before] = behind;
    this->previous_[behind] = before;
  }

private:
  Neighbours next_;
  Neighbours previous_;
};

/// Reads the code of a hole. It reads up to kPackedPadding bytes behind the code.
class HoleCode
{
public:
  /// @param numberBits b
  HoleCode(const HoleCounts& counts, const unsigned char* code, bool hasSources, int numberBits)
    : code_(code)
    , places_(2 * counts.oldCount)
    , numbers_(counts.formBits[hasSources ? 1 : 0])
    , placeBits_(counts.placeBits)
    , numberBits_(numberBits)
    , newCount_(counts.newCount)
  {
  }

  /// Corner of the node in an old triangle, or 3, which is none.
  int corner(int oldTriangle) const
  {
    return this->code_[oldTriangle / 4] >> (2 * (oldTriangle % 4)) & 3;
  }
  int ear(int newTriangle) const { return this->place(newTriangle); }

  /// If there are sources.
  int source(int newTriangle) const { return this->place(this->newCount_ + newTriangle); }

  /// Number i of the patch: the slot of a new triangle or, if there is none, a listed node.
  Index number(int i) const
  {
    return static_cast<Index>(
      packedBits(this->code_, this->numbers_ + this->numberBits_ * i, this->numberBits_));
  }

private:
  int place(int i) const
  {
    const int begin = this->places_ + this->placeBits_ * i;
    const unsigned char* bytes = this->code_ + begin / 8;
    const unsigned bits = bytes[0] | static_cast<unsigned>(bytes[1]) << 8;
    return static_cast<int>(bits >> begin % 8 & ((1U << this->placeBits_) - 1));
  }

  const unsigned char* code_;
  int places_;  // the first bit of the ears
  int numbers_; // and of the slots
  int placeBits_;
  int numberBits_;
  int newCount_;
};

/// The old triangles of a hole of which the sources are known, while those that are lost come back
/// in their order: the ones from which new triangles take their values and, later, those before.
class KnownSources
{
public:
  /// @param source int(newTriangle): the old triangle from which it takes its values
  template <typename Source>
  KnownSources(int newCount, int oldCount, const Source& source)
    : oldCount_(oldCount)
  {
    for (int i = 0; i < newCount; ++i)
    {
      this->known_ |= std::uint64_t{ 1 } << source(i);
    }
  }

  bool has(int oldTriangle) const { return (this->known_ >> oldTriangle & 1) != 0; }
  int count() const { return countBits(this->known_); }
  void add(int oldTriangle) { this->known_ |= std::uint64_t{ 1 } << oldTriangle; }

  /// The first of them that shows a source, or -1.
  /// @param sources of the old triangles, where they are known
  int placeOf(Index source, const Index* sources) const
  {
    for (int i = 0; i < this->oldCount_; ++i)
    {
      if (sources[i] == source && this->has(i))
      {
        return i;
      }
    }
    return -1;
  }

private:
  int oldCount_;
  std::uint64_t known_ = 0;
};

} // namespace undecimate

#endif
