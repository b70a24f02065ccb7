#include "app/src/lens_page.h"

#include "app/src/html_report.h"
#include "app/src/lens_picture.h"
#include "app/src/lens_report_writers.h"

namespace catoptra::app {

std::string lens_page(const LensReport& report, const LensSource& source) {
  HtmlPage page;
  page.title = "Lens " + report.lens;
  page.summary = "What the lens does to the light, measured by exact rays";
  page.lenses.push_back(lens_report_json(report));
  page.lenses.back()["picture"] =
      data_address(lens_picture_png(source, report.options.evaluation.position), "image/png");
  page.inputs = page.lenses.back()["inputs"];
  return html_report(page);
}

}  // namespace catoptra::app
