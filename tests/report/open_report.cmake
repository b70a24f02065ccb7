# Begins with an empty FOLDER for the test's files. open_report(FILE PLOTS): opens a report in the browser and checks it.
include(${SOURCE_DIR}/tests/front_door/run.cmake)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
function(open_report file plots)
  run("${file} in the browser" ${NODE} ${CHECK} ${file} ${plots} ${FOLDER})
endfunction()
