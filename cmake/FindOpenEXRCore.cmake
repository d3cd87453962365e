# Finds OpenEXRCore, the C library of OpenEXR (BSD-3-Clause). OpenEXR's own CMake files ask for a C++ compiler and
# for Imath, which the C library does not need, and its pkg-config file names the C++ library.
# Defines OpenEXR::OpenEXRCore.
find_path(OPENEXRCORE_INCLUDE_DIR openexr.h PATH_SUFFIXES OpenEXR)
find_library(OPENEXRCORE_LIBRARY OpenEXRCore)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenEXRCore REQUIRED_VARS OPENEXRCORE_LIBRARY OPENEXRCORE_INCLUDE_DIR)
if(OpenEXRCore_FOUND AND NOT TARGET OpenEXR::OpenEXRCore)
  add_library(OpenEXR::OpenEXRCore UNKNOWN IMPORTED)
  set_target_properties(OpenEXR::OpenEXRCore PROPERTIES IMPORTED_LOCATION "${OPENEXRCORE_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OPENEXRCORE_INCLUDE_DIR}")
endif()
