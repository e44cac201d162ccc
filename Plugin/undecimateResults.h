// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateResults.h
/// @brief Keeps the information-only properties of our proxies up to date.

#ifndef undecimateResults_h
#define undecimateResults_h

/// Have the results (NumberOfNodes, Error, ...) of each of our proxies fetched whenever its
/// pipeline was updated. ParaView by itself fetches such properties before the update, so the panel
/// and Python would show the results of the last but one. Called when the plugin is loaded; does
/// nothing in a server process, which has no proxies.
void undecimateWatchResults();

#endif
