# A spectacle lens that somebody else designed: ten B-splines of degree 5.
include(${CMAKE_CURRENT_LIST_DIR}/open_report.cmake)
if("$ENV{CATOPTRA_CORPUS}" STREQUAL "")
  message(STATUS "CATOPTRA_CORPUS does not name a folder of CAD files")
  return()
endif()
run("evaluate" ${BUILD_DIR}/catoptra lens evaluate $ENV{CATOPTRA_CORPUS}/lenses/ossg_Lens.stp --material CR-39 --mode as-worn
    --gaze-max 30 --gaze-step 5 --html ${FOLDER}/spectacle.html)
open_report(${FOLDER}/spectacle.html 8)
