# catoptra_add_report(TARGET): compiles the parts of the HTML report into TARGET, with Plotly.js as app/report/package-lock.json pins it.
include(CatoptraNpm)
function(catoptra_add_report target)
  set(from ${CMAKE_CURRENT_SOURCE_DIR}/report)
  catoptra_npm_ci(${from} ${CMAKE_CURRENT_BINARY_DIR}/report)
  file(READ ${from}/package.json package)
  string(JSON CATOPTRA_PLOTLY_VERSION GET "${package}" dependencies plotly.js-cartesian-dist-min)
  set(CATOPTRA_PLOTLY ${CMAKE_CURRENT_BINARY_DIR}/report/node_modules/plotly.js-cartesian-dist-min/plotly-cartesian.min.js)

  catoptra_embed_texts(CATOPTRA_REPORT report "" part batch.js lens.js main.js mirror.js page.js report.css report.html.in)
  configure_file(src/report_assets.cpp.in report_assets.cpp @ONLY)
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/report_assets.cpp)
  set_property(SOURCE ${CMAKE_CURRENT_BINARY_DIR}/report_assets.cpp APPEND PROPERTY OBJECT_DEPENDS ${CATOPTRA_PLOTLY})
endfunction()
