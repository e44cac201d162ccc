# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reversible decimation of triangle meshes: the VTK filters of Undecimate."""
