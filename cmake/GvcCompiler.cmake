# Language level, warnings and sanitizers for every target, and the two helpers that make a layer and
# a test.

set(CMAKE_C_STANDARD 11)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_compile_definitions(_POSIX_C_SOURCE=200809L _FILE_OFFSET_BITS=64)
# Results must not depend on whether the compiler fuses a multiply and an add.
add_compile_options(-Wall -Wextra -ffp-contract=off)
add_compile_options($<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes> -Wshadow -Wpointer-arith -Wvla)
if(GVC_WERROR)
  add_compile_options(-Werror)
endif()
if(GVC_SANITIZE)
  add_compile_options(-fsanitize=${GVC_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
  add_link_options(-fsanitize=${GVC_SANITIZE})
endif()

# gvc_layer(NAME SOURCES ... DEPENDS layer... LIBRARIES lib...)
# A layer is compiled once (gvc_NAME_objects), becomes part of libgvc, and can be linked alone by tests and
# fuzz harnesses (gvc_NAME). DEPENDS names the layers below it.
function(gvc_layer name)
  cmake_parse_arguments(L "" "" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
  add_library(gvc_${name}_objects OBJECT ${L_SOURCES})
  target_include_directories(gvc_${name}_objects PUBLIC
    "${PROJECT_SOURCE_DIR}/libgvc/include" "${PROJECT_SOURCE_DIR}/libgvc")
  target_link_libraries(gvc_${name}_objects PUBLIC ${L_LIBRARIES})
  add_library(gvc_${name} STATIC $<TARGET_OBJECTS:gvc_${name}_objects>)
  target_include_directories(gvc_${name} PUBLIC
    "${PROJECT_SOURCE_DIR}/libgvc/include" "${PROJECT_SOURCE_DIR}/libgvc")
  list(TRANSFORM L_DEPENDS PREPEND gvc_ OUTPUT_VARIABLE below)
  target_link_libraries(gvc_${name} PUBLIC ${below} ${L_LIBRARIES})
  set_property(GLOBAL APPEND PROPERTY GVC_LAYERS ${name})
endfunction()

# Leaks of other libraries that LeakSanitizer should not report.
set(GVC_TEST_ENVIRONMENT
  "LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/lsan.supp:print_suppressions=0")

# gvc_test(NAME LIBRARIES ...): builds test_NAME.c of this folder and registers it.
function(gvc_test name)
  cmake_parse_arguments(T "" "" "LIBRARIES" ${ARGN})
  add_executable(test_${name} test_${name}.c)
  target_link_libraries(test_${name} PRIVATE ${T_LIBRARIES} PkgConfig::CMOCKA m)
  add_test(NAME ${name} COMMAND test_${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT 600
    ENVIRONMENT "${GVC_TEST_ENVIRONMENT}")
endfunction()
