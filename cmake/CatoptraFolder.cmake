# catoptra_add_folder(NAME SOURCES ... HEADERS ... PUBLIC libs PRIVATE libs)
# makes the library catoptra_NAME with alias catoptra::NAME. HEADERS are the public ones on top of the folder;
# they form a verified file set, included as "NAME/header.h" from the repository's root.
function(catoptra_add_folder name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(target catoptra_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(catoptra::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC glm::glm ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE}
                        $<BUILD_INTERFACE:catoptra_compile_options>)
endfunction()
