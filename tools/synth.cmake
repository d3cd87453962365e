# The maker of the sample capture, for the program and for tests.
if(NOT TARGET gvc_synth)
  add_library(gvc_synth STATIC "${CMAKE_CURRENT_LIST_DIR}/synth.c"
    "${CMAKE_CURRENT_LIST_DIR}/synth_figure.c")
  target_include_directories(gvc_synth PUBLIC "${CMAKE_CURRENT_LIST_DIR}")
  target_link_libraries(gvc_synth PUBLIC gvc_mesh)
endif()
