# The main example's mirror, judged by a rule.
include(${CMAKE_CURRENT_LIST_DIR}/open_report.cmake)
run("evaluate" ${BUILD_DIR}/catoptra mirror evaluate ${BUILD_DIR}/examples/door_mirror.toml --rule R46-III --html ${FOLDER}/door.html)
open_report(${FOLDER}/door.html 5)  # the road, and four maps of the glass
