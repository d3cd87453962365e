# gvc_compare: what `gvc compare` measures with. Include from tools/CMakeLists.txt and link the
# program with gvc_compare, which brings libgvc and its base layer (buffers, threads, text). Draco
# has a C++ interface only; this is the one place where C++ is compiled.
enable_language(CXX)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
# Imported targets are known per folder: gvc_base needs libavutil's here too.
pkg_check_modules(AVCODEC REQUIRED IMPORTED_TARGET libavcodec libavutil)
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(DRACO REQUIRED IMPORTED_TARGET draco)
pkg_check_modules(LZMA REQUIRED IMPORTED_TARGET liblzma)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)

add_library(gvc_compare OBJECT
  "${CMAKE_CURRENT_LIST_DIR}/compare.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_draco.cc"
  "${CMAKE_CURRENT_LIST_DIR}/compare_gvc.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_lossless.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper_data.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper_gis.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper_images.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper_ours.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper_plot.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper_print.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_paper_rows.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_print.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_text.c"
  "${CMAKE_CURRENT_LIST_DIR}/compare_zip.c"
  "${CMAKE_CURRENT_LIST_DIR}/plot.c"
  "${CMAKE_CURRENT_LIST_DIR}/simplify.c")
target_include_directories(gvc_compare PUBLIC
  "${CMAKE_CURRENT_LIST_DIR}" "${PROJECT_SOURCE_DIR}/libgvc/include" "${PROJECT_SOURCE_DIR}/libgvc")
target_link_libraries(gvc_compare PUBLIC gvc gvc_base PkgConfig::LIBZIP PkgConfig::DRACO
  PkgConfig::LZMA PkgConfig::ZSTD)
