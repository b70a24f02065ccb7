# A toric lens as worn, its limits, and a progressive lens's map; the second report's name must not become markup.
include(${CMAKE_CURRENT_LIST_DIR}/open_report.cmake)
set(program ${BUILD_DIR}/catoptra)
run("make" ${program} lens make --sph -4 --cyl -1.5 --axis 20 --material CR-39 -o ${FOLDER}/toric.step)
run("evaluate" ${program} lens evaluate ${FOLDER}/toric.step --material CR-39 --mode as-worn --gaze-max 35 --gaze-step 5
    --rule iso-8980-1-2004 --ordered-sph -4 --ordered-cyl -1.5 --ordered-axis 20 --html ${FOLDER}/toric.html)
open_report(${FOLDER}/toric.html 8)  # six maps and two profiles
run("make" ${program} lens make --sph 1 --add 2 --index 1.6 -o "${FOLDER}/<b>progressive<script>.step")
run("evaluate" ${program} lens evaluate "${FOLDER}/<b>progressive<script>.step" --index 1.6 --map-step 4
    --html ${FOLDER}/progressive.html)
open_report(${FOLDER}/progressive.html 6)  # no distortion by the focimeter, no colour without dispersion
