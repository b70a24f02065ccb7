# A batch with a case that fails: quantities against each other, how often, and the maps of one lens.
include(${CMAKE_CURRENT_LIST_DIR}/open_report.cmake)
set(program ${BUILD_DIR}/catoptra)
file(WRITE ${FOLDER}/plan.toml [=[
[[prescriptions]]
sph = [-4, 0, 4]
cyl = [0, -1.5]
axis = 30
center_thickness = [2, 3]                     # too thin for the plus lenses: two cases fail
material = "CR-39"

[[poses]]
mode = "as-worn"

[[gaze]]
max_deg = 30
step_deg = 5
]=])
run("run" ${program} batch run ${FOLDER}/plan.toml --db ${FOLDER}/results.sqlite)
run("report" ${program} batch report --db ${FOLDER}/results.sqlite -o ${FOLDER}/batch.html)
open_report(${FOLDER}/batch.html 10)  # two of the batch, and of the lens six maps and two profiles
