# Measures the validation table and requires that the README shows the same one, digit for digit.
include(${SOURCE_DIR}/tests/front_door/run.cmake)
run("measure" ${PROGRAM} ${BUILD_DIR}/examples ${BUILD_DIR}/validation.md)
file(READ ${BUILD_DIR}/validation.md measured)
file(READ ${SOURCE_DIR}/README.md readme)
string(FIND "${readme}" "${measured}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "README.md does not hold the table as measured now (scripts/update_validation.sh writes it):\n${measured}")
endif()
