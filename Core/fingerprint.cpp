// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fingerprint.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace undecimate
{

struct Fingerprint::State
{
  XXH3_state_t hash;
};

Fingerprint::Fingerprint()
  : state_(std::make_unique<State>())
{
  XXH3_64bits_reset(&this->state_->hash);
}

Fingerprint::~Fingerprint() = default;

void Fingerprint::add(const void* bytes, std::size_t size)
{
  if (size > 0)
  {
    XXH3_64bits_update(&this->state_->hash, bytes, size);
  }
}

void Fingerprint::add(std::int64_t number)
{
  this->add(&number, sizeof(number));
}

void Fingerprint::add(const std::string& text)
{
  this->add(static_cast<std::int64_t>(text.size()));
  this->add(text.data(), text.size());
}

std::uint64_t Fingerprint::value() const
{
  return XXH3_64bits_digest(&this->state_->hash);
}

} // namespace undecimate
