// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file fingerprint.h
/// @brief A 64-bit hash by which a record knows the mesh that it belongs to.

#ifndef UNDECIMATE_CORE_FINGERPRINT_H
#define UNDECIMATE_CORE_FINGERPRINT_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace undecimate
{

/// XXH3 (64 bit) over all that was added, in order. Guards against accidents, not against malice.
class Fingerprint
{
public:
  Fingerprint();
  ~Fingerprint();

  void add(const void* bytes, std::size_t size);
  void add(const std::string& text); ///< with its length, so that "ab","c" differs from "a","bc"
  void add(std::int64_t number);
  std::uint64_t value() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace undecimate

#endif
