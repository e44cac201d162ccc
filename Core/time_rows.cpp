// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "time_rows.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

TimeRows::TimeRows(Index nodeCount, int components, int steps)
  : nodeCount_(nodeCount)
  , components_(components)
  , steps_(steps)
  , lanes_(lanesFor(steps))
  , size_(static_cast<std::size_t>(components) * this->lanes_)
{
  this->values_.resize(this->size_ * nodeCount);
  std::fill(this->values_.begin(), this->values_.end(), 0.0F);
}

template <typename Real>
void TimeRows::set(
  int step, const Real* values, const Real* added, const double* origin, double scale)
{
  for (Index node = 0; node < this->nodeCount_; ++node)
  {
    float* row = this->values_.data() + this->size_ * node;
    for (int c = 0; c < this->components_; ++c, row += this->lanes_)
    {
      const std::size_t i = static_cast<std::size_t>(this->components_) * node + c;
      const double value = static_cast<double>(values[i]) + (added ? added[i] : Real{ 0 });
      float lane = static_cast<float>((value - origin[c]) * scale);
      if (!std::isfinite(lane))
      {
        if (this->nonFinite_.empty())
        {
          this->nonFinite_.assign(this->nodeCount_, false);
        }
        this->nonFinite_[node] = true;
        lane = 0.0F;
      }
      row[step] = lane;
      if (step == 0)
      {
        std::fill(row + this->steps_, row + this->lanes_, lane);
      }
    }
  }
}

TimeRows TimeRows::select(const std::vector<int>& steps) const
{
  TimeRows some(this->nodeCount_, this->components_, static_cast<int>(steps.size()));
  for (Index node = 0; node < this->nodeCount_; ++node)
  {
    const float* from = this->at(node);
    float* to = some.values_.data() + some.size_ * node;
    for (int c = 0; c < this->components_; ++c, from += this->lanes_, to += some.lanes_)
    {
      for (int lane = 0; lane < some.lanes_; ++lane)
      {
        to[lane] = from[lane < some.steps_ ? steps[lane] : steps[0]];
      }
    }
  }
  some.nonFinite_ = this->nonFinite_;
  return some;
}

double largestMove(const TimeRows& a, int stepOfA, const TimeRows& b, int stepOfB)
{
  float largest = 0.0F;
  for (Index node = 0; node < a.nodeCount(); ++node)
  {
    float square = 0.0F;
    for (int c = 0; c < a.components(); ++c)
    {
      const float move = a.at(node)[c * a.lanes() + stepOfA] - b.at(node)[c * b.lanes() + stepOfB];
      square += move * move;
    }
    largest = std::max(largest, square);
  }
  return std::sqrt(static_cast<double>(largest));
}

template <typename Real>
PositionFrame positionFrame(const Real* points, const Real* added, Index nodeCount)
{
  std::array<double, 3> low{ HUGE_VAL, HUGE_VAL, HUGE_VAL };
  std::array<double, 3> high{ -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
  for (std::size_t i = 0; i < std::size_t{ 3 } * nodeCount; ++i)
  {
    const double value = static_cast<double>(points[i]) + (added ? added[i] : Real{ 0 });
    if (std::isfinite(value))
    {
      low[i % 3] = std::min(low[i % 3], value);
      high[i % 3] = std::max(high[i % 3], value);
    }
  }
  PositionFrame frame;
  double square = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    if (low[c] <= high[c])
    {
      frame.origin[c] = 0.5 * (low[c] + high[c]);
      square += (high[c] - low[c]) * (high[c] - low[c]);
    }
  }
  if (square > 0.0 && std::isfinite(square))
  {
    frame.scale = 1.0 / std::sqrt(square);
  }
  return frame;
}

template void TimeRows::set(int, const float*, const float*, const double*, double);
template void TimeRows::set(int, const double*, const double*, const double*, double);
template PositionFrame positionFrame(const float*, const float*, Index);
template PositionFrame positionFrame(const double*, const double*, Index);

} // namespace undecimate
