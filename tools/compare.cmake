# gvc_compare: what `gvc compare` measures with. Include from tools/CMakeLists.txt and link the
# program with gvc_compare and libgvc. Draco has a C++ interface only; this is the one place where
# C++ is compiled.
enable_language(CXX)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

find_package(PkgConfig REQUIRED)
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(DRACO REQUIRED IMPORTED_TARGET draco)

add_library(gvc_compare OBJECT
  compare.c compare_draco.cc compare_gvc.c compare_print.c compare_zip.c)
target_include_directories(gvc_compare PUBLIC
  "${CMAKE_CURRENT_SOURCE_DIR}"
  "${PROJECT_SOURCE_DIR}/libgvc/include" "${PROJECT_SOURCE_DIR}/libgvc")
target_link_libraries(gvc_compare PUBLIC PkgConfig::LIBZIP PkgConfig::DRACO)
