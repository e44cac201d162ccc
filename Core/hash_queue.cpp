// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hash_queue.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

ExponentialIntervals::ExponentialIntervals(double smallest, double largest, Index count)
  : scale_(largest > 0.0 ? 1.0 / largest : 0.0)
  , sum_(smallest * this->scale_ + 1.0)
  , delta_(1.0 - smallest * this->scale_)
  , length_(1.0)
  , count_(std::max<Index>(1, count))
{
  // D = 0 would divide by zero in both formulas: all values equal need one interval. So do values
  // so small that they cannot be normalised.
  if (!std::isfinite(this->scale_) || !(largest > 0.0) || !(this->delta_ > 0.0))
  {
    this->delta_ = 0.0;
    this->count_ = 1;
    return;
  }
  this->length_ = 1.0 / std::log1p(this->delta_); // e_max is 1 after normalisation
}

double ExponentialIntervals::bound(Index j) const
{
  if (this->delta_ == 0.0)
  {
    // The two ends of eq. 2 still hold: d_0 = e_min and d_m = e_min + e_max.
    const double largest = this->scale_ > 0.0 ? 1.0 / this->scale_ : 0.0;
    return j == 0 ? largest : 2.0 * largest;
  }
  const double x = 1.0 + this->delta_ - j * (this->delta_ / this->count_);
  return (this->sum_ - this->length_ * std::log(x)) / this->scale_;
}

Index ExponentialIntervals::interval(double value) const
{
  const double e = value * this->scale_;
  if (this->delta_ == 0.0 || !(e < 1.0))
  {
    return this->count_ - 1;
  }
  const double x = 1.0 + this->delta_ - std::exp((this->sum_ - e) / this->length_);
  const double j = std::floor(x * (this->count_ / this->delta_));
  return j <= 0.0 ? 0 : std::min(static_cast<Index>(j), this->count_ - 1);
}

IntervalBits::IntervalBits(Index intervalCount)
{
  std::size_t words = intervalCount;
  for (auto& level : this->bits_)
  {
    words = (words + 63) / 64;
    level.assign(words, 0);
  }
}

// Up to the first level that has a bit behind the interval, and down again.
Index IntervalBits::above(Index interval) const
{
  for (int level = 0; level < kLevels; ++level, interval >>= 6)
  {
    const std::uint64_t behind = ~std::uint64_t{ 1 } << (interval & 63);
    const std::uint64_t word = this->bits_[level][interval >> 6] & behind;
    if (word != 0)
    {
      interval = (interval & ~Index{ 63 }) + lowestBit(word);
      while (level > 0)
      {
        interval = (interval << 6) + lowestBit(this->bits_[--level][interval]);
      }
      return interval;
    }
  }
  return kNone;
}

} // namespace undecimate
