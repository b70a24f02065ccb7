# Language standard, warnings, compiler cache and sanitizers, shared by every target.
include(GNUInstallDirs)

option(CATOPTRA_BUILD_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(CATOPTRA_WERROR "Treat warnings as errors" OFF)
set(CATOPTRA_SANITIZE "" CACHE STRING "Sanitizer: empty, address or thread")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# One interface target carries what every folder compiles with. Contraction of a*b+c into fused operations is off,
# so that results do not depend on the instruction set a function happens to be compiled for.
add_library(catoptra_compile_options INTERFACE)
target_compile_options(catoptra_compile_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -ffp-contract=off $<$<BOOL:${CATOPTRA_WERROR}>:-Werror>)
if(CATOPTRA_SANITIZE)
  add_compile_options(-fsanitize=${CATOPTRA_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${CATOPTRA_SANITIZE})
endif()
