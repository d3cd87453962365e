# The software renderer.
pkg_check_modules(PNG REQUIRED IMPORTED_TARGET GLOBAL libpng)
add_library(gvc_render STATIC render.c render_mesh.c render_curve.c render_figure.c render_image.c
  render_font.c render_png.c render_page.c)
target_include_directories(gvc_render PUBLIC "${CMAKE_CURRENT_SOURCE_DIR}")
target_link_libraries(gvc_render PUBLIC gvc_mesh PRIVATE PkgConfig::PNG m)
