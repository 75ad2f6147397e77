#pragma once

#include <string>

namespace bowstring::study {

/// The report as one HTML text that opens without a network: the page of this folder, Chart.js and `report_json`
/// (`bowstring.report/1`, README.md). The JSON is put in as it is, but for `<`, so that no name in it ends its element;
/// it is not checked.
std::string report_page(const std::string& report_json);

}  // namespace bowstring::study
