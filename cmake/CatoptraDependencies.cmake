# Every third-party package, each used by the one folder named beside it.
find_package(glm REQUIRED)                                         # everybody       libglm-dev
find_package(OpenCASCADE 7.6.3 REQUIRED)                           # cad_import      libocct-*-dev
find_package(assimp 5.2 REQUIRED)                                  # cad_import      libassimp-dev
find_package(PkgConfig REQUIRED)
# By pkg-config: Debian's CMake file of libzip asks for its command line programs.
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip>=1.7)     # cad_import      libzip-dev
find_package(pugixml 1.13 REQUIRED)                                # cad_import      libpugixml-dev
pkg_check_modules(OPENMESH REQUIRED IMPORTED_TARGET openmesh)      # tessellate      libopenmesh-dev
find_package(embree 3.13 REQUIRED)                                 # optics          libembree-dev
find_package(yaml-cpp 0.7 REQUIRED)                                # optics          libyaml-cpp-dev
find_package(TBB REQUIRED)                                         # optics, render  libtbb-dev
find_package(OpenImageIO 2.4 REQUIRED)                             # render          libopenimageio-dev
# Debian's OpenImageIO names OpenCV's include folder without depending on it; nothing here needs it.
get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER oiio_includes EXCLUDE REGEX opencv)
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_includes}")
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)            # render          libepoxy-dev
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)                # render          libegl-dev
find_package(nlohmann_json 3.11 REQUIRED)                          # app, examples   nlohmann-json3-dev
find_package(CLI11 REQUIRED)                                       # app             libcli11-dev
find_package(tomlplusplus REQUIRED)                                # app             libtomlplusplus-dev
find_package(spdlog REQUIRED)                                      # app             libspdlog-dev
find_package(OpenSSL 3.0 REQUIRED COMPONENTS Crypto)               # app             libssl-dev
# app: Debian's interpreter, whose modules (NumPy, Dask) the package uses, whatever else the PATH has first. Another one:
# -DPython3_EXECUTABLE=...
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter Development.Module)  # app         python3-dev
set(PYBIND11_FINDPYTHON ON)
set(PYBIND11_PYTHON_VERSION ${Python3_VERSION})
set(Python_EXECUTABLE ${Python3_EXECUTABLE})
find_package(pybind11 2.10 REQUIRED)                               # app             pybind11-dev
find_package(SQLite3 3.40 REQUIRED)                                # app             libsqlite3-dev
find_package(Freetype REQUIRED)                                    # examples        libfreetype-dev
if(CATOPTRA_BUILD_TESTS)
  find_package(GTest REQUIRED)                                     # tests           libgtest-dev
endif()
