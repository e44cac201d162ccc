# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause

option(UNDECIMATE_SANITIZE "Build with the address and undefined-behaviour sanitizers" OFF)
option(UNDECIMATE_WERROR "Make compiler warnings errors" OFF)

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if (UNDECIMATE_SANITIZE)
  # For all targets: every library of a process has to agree. Little optimisation, since it costs
  # more time to compile than it saves, and assertions are on. What the address sanitizer sees anyway
  # (null pointers, wrong objects) is not looked at twice.
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
  add_compile_options(-fsanitize=address,undefined -fno-sanitize=null,object-size,vptr
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif ()

# undecimate_compile_options(<target> [option...]): warnings, and floating-point results that do not depend on
# the compiler's choice of fused multiply-adds.
function (undecimate_compile_options target)
  if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(${target} PRIVATE
      -Wall -Wextra
      -ffp-contract=off -fno-math-errno -fno-trapping-math
      $<$<BOOL:${UNDECIMATE_WERROR}>:-Werror> ${ARGN})
  endif ()
endfunction ()

# undecimate_test_options(<target>): the same for a test program. With the sanitizers it takes half the time to
# compile: by the optimisation that is made for it, with the headers of GoogleTest compiled once, and whether addresses
# are aligned is asked of the libraries only.
function (undecimate_test_options target)
  undecimate_compile_options(${target} ${ARGN})
  if (UNDECIMATE_SANITIZE)
    target_compile_options(${target} PRIVATE -Og -fno-sanitize=alignment)
    target_precompile_headers(${target} PRIVATE
      <gtest/gtest.h> <algorithm> <cmath> <functional> <random> <set> <string> <vector>)
  endif ()
endfunction ()
