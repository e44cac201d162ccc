# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause

# The package that find_package(Undecimate) reads; vtk_module_build() has written the targets and
# the module properties beside it.

include(CMakePackageConfigHelpers)

configure_package_config_file(CMake/UndecimateConfig.cmake.in
  "${CMAKE_BINARY_DIR}/${package_dir}/UndecimateConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
# Before 1.0 a minor version may break the interface.
write_basic_package_version_file(
  "${CMAKE_BINARY_DIR}/${package_dir}/UndecimateConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(
  FILES
    "${CMAKE_BINARY_DIR}/${package_dir}/UndecimateConfig.cmake"
    "${CMAKE_BINARY_DIR}/${package_dir}/UndecimateConfigVersion.cmake"
  DESTINATION "${package_dir}"
  COMPONENT   development)
