# catoptra_embed_texts(PREFIX FOLDER SUFFIX DELIMITER name...): text files FOLDER/nameSUFFIX as entries of a C++ table, for a file that
# configure_file() fills in. Sets PREFIX_COUNT and PREFIX_ENTRIES ({"name", raw string}, one a line) for the caller.
function(catoptra_embed_texts prefix folder suffix delimiter)
  list(LENGTH ARGN count)
  set(entries "")
  foreach(name IN LISTS ARGN)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/${name}${suffix})
    file(READ ${folder}/${name}${suffix} text)
    string(APPEND entries "    {\"${name}\", R\"${delimiter}(${text})${delimiter}\"},\n")
  endforeach()
  set(${prefix}_COUNT ${count} PARENT_SCOPE)
  set(${prefix}_ENTRIES "${entries}" PARENT_SCOPE)
endfunction()
