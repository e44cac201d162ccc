// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file monitor.h
/// @brief Progress and cancellation of long core calls.

#ifndef UNDECIMATE_CORE_MONITOR_H
#define UNDECIMATE_CORE_MONITOR_H

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

namespace undecimate
{

/// The one object through which the core reports progress and hears cancel.
///
/// The core calls update() with a fraction that never decreases and ends at 1. The host's callback
/// runs in the thread of the core call, at each half per cent and otherwise twenty times a second,
/// and returns false to cancel. cancel() may be called from any thread. A monitor may be used for
/// one call after the other; reset() forgets an earlier cancellation.
class Monitor
{
public:
  using Callback = std::function<bool(double fraction)>;

  Monitor() = default;
  explicit Monitor(Callback callback)
    : callback_(std::move(callback))
  {
  }

  /// Ask the running call, or the next one, to stop. Idempotent, from any thread.
  void cancel() { this->cancelled_ = true; }
  bool cancelled() const { return this->cancelled_; }

  /// Fraction done of the running or the last call, in [0, 1].
  double progress() const { return this->progress_; }

  /// Start anew: no progress, not cancelled.
  void reset()
  {
    this->cancelled_ = false;
    this->progress_ = 0.0;
  }

  /// For the core: report a fraction; false when the call has to stop.
  bool update(double fraction)
  {
    if (this->cancelled_)
    {
      return false;
    }
    // Within a call fractions do not decrease, so a smaller one is the next call's.
    const bool anew = fraction < this->progress_;
    const double done = anew ? 0.0 : this->progress_.load();
    const Clock::time_point now = Clock::now();
    const bool further = fraction - done >= 0.005 || (fraction >= 1.0 && done < 1.0);
    if (further || anew || now - this->asked_ >= std::chrono::milliseconds(50))
    {
      this->asked_ = now;
      if (fraction > done || anew)
      {
        this->progress_ = fraction > 1.0 ? 1.0 : fraction;
      }
      if (this->callback_ && !this->callback_(this->progress_))
      {
        this->cancelled_ = true;
      }
    }
    return !this->cancelled_;
  }

private:
  using Clock = std::chrono::steady_clock;

  Callback callback_;
  Clock::time_point asked_ = Clock::now();
  std::atomic<bool> cancelled_{ false };
  std::atomic<double> progress_{ 0.0 };
};

/// A part of a call: fractions from 0 to 1 of the part are those from `begin` to `end` of the call.
/// Without a monitor nothing is reported and nothing cancels.
class MonitorShare
{
public:
  explicit MonitorShare(Monitor* monitor, double begin = 0.0, double end = 1.0)
    : monitor_(monitor)
    , begin_(begin)
    , end_(end)
  {
  }

  /// A part of this part.
  MonitorShare part(double begin, double end) const
  {
    return MonitorShare(this->monitor_, this->at(begin), this->at(end));
  }

  /// As Monitor::update().
  bool update(double fraction) const
  {
    return !this->monitor_ || this->monitor_->update(this->at(fraction));
  }

  /// For loops over many small things: asks the monitor once in a while only.
  /// @param done, count the loop is at index `done` of `count`
  bool updateAt(std::int64_t done, std::int64_t count) const
  {
    return done % kInterval != 0 ||
      this->update(static_cast<double>(done) / static_cast<double>(count));
  }

private:
  static constexpr std::int64_t kInterval = 1 << 14;

  double at(double fraction) const { return this->begin_ + (this->end_ - this->begin_) * fraction; }

  Monitor* monitor_;
  double begin_;
  double end_;
};

} // namespace undecimate

#endif
