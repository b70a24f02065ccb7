# Installs the build into an empty folder, builds tests/consumer against it and runs that on an installed example.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set(prefix ${BUILD_DIR}/tests/consumer/prefix)
file(REMOVE_RECURSE ${BUILD_DIR}/tests/consumer)
run("install" ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
if(SANITIZE)
  set(sanitizer -D CMAKE_CXX_FLAGS=-fsanitize=${SANITIZE})
endif()
run("configure" ${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/consumer -B ${BUILD_DIR}/tests/consumer/build -G Ninja
    -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release ${sanitizer})
run("build" ${CMAKE_COMMAND} --build ${BUILD_DIR}/tests/consumer/build)
run("consumer" ${BUILD_DIR}/tests/consumer/build/consumer ${prefix}/share/catoptra/examples/door_mirror.step)
run("installed catoptra" ${prefix}/bin/catoptra --version)
must_exist(${prefix}/share/man/man1/catoptra.1 ${prefix}/share/bash-completion/completions/catoptra
           ${prefix}/share/catoptra/examples/street.glb ${prefix}/share/catoptra/examples/door_mirror.toml)
run("installed example" ${prefix}/bin/catoptra render ${prefix}/share/catoptra/examples/door_mirror.toml
    --resolution 160,90 -o ${BUILD_DIR}/tests/consumer/picture.png)
must_exist(${BUILD_DIR}/tests/consumer/picture.png)
