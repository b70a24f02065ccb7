# What `make demo` does, at a small size: pictures, and numbers in the report that belong together.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set(folder ${BUILD_DIR}/tests/main_example)
file(REMOVE_RECURSE ${folder})
run("compare" ${BUILD_DIR}/catoptra compare ${BUILD_DIR}/examples/door_mirror.toml -o ${folder} --resolution 320,180
    --modes pvrr,hybrid,cubemap)
must_exist(${folder}/pvrr.png ${folder}/raytrace.png ${folder}/error_pvrr.png ${folder}/report.json)
file(READ ${folder}/report.json report)
# p99 in units of 0.001 arcmin: CMake counts in integers.
foreach(mode pvrr hybrid cubemap)
  string(JSON p99 GET ${report} modes ${mode} optics 0 error_arcmin p99)
  execute_process(COMMAND awk "BEGIN { printf \"%d\", ${p99} * 1000 }" OUTPUT_VARIABLE ${mode}_p99)
endforeach()
if(NOT pvrr_p99 LESS cubemap_p99)
  message(FATAL_ERROR "pvrr (p99 ${pvrr_p99}) is not better than cubemap (${cubemap_p99}), in 0.001 arcmin")
endif()
if(NOT hybrid_p99 LESS pvrr_p99)
  message(FATAL_ERROR "hybrid (p99 ${hybrid_p99}) is not better than pvrr (${pvrr_p99}), in 0.001 arcmin")
endif()
