// CampaignPage: the joined experiments as a table for terminals and as a self-contained page.
// Normal thread.
#pragma once

#include "src/report/html_report.hpp"
#include "src/report/table.hpp"
#include "src/tool/campaign_results.hpp"

namespace gannet::tool {

report::Table campaign_table(const Campaign& campaign);
report::HtmlReport campaign_page(const Campaign& campaign);

}  // namespace gannet::tool
