// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateCompatibility.h
/// @brief What differs between the VTK versions that the filters build with (9.1 and later).

#ifndef undecimateCompatibility_h
#define undecimateCompatibility_h

namespace undecimate
{
namespace filters
{

/// True when the user asked the filter to stop. vtkAlgorithm::CheckAbort() also hears an abort of
/// filters further up; it exists from VTK 9.3 (and in ParaView 5.11's snapshot of 9.2), which no
/// version macro tells apart, so the compiler is asked.
template <class Algorithm>
auto checkAbort(Algorithm* algorithm, int) -> decltype(static_cast<bool>(algorithm->CheckAbort()))
{
  return algorithm->CheckAbort();
}

template <class Algorithm>
bool checkAbort(Algorithm* algorithm, long)
{
  return algorithm->GetAbortExecute() != 0;
}

} // namespace filters
} // namespace undecimate

#endif
