// Subcommands that need no daemon: they work on files. Normal thread.
#pragma once

#include "src/tool/subcommands.hpp"

namespace gannet::tool {

Subcommand model_build_subcommand();      // photo → .gannet file
Subcommand model_list_subcommand();       // a folder of .gannet files
Subcommand model_show_subcommand();       // what one is good for
Subcommand locate_subcommand();           // one stereo pair → pose
Subcommand which_subcommand();            // one stereo pair → which model
Subcommand track_subcommand();            // a folder of pairs → a table of poses
Subcommand map_subcommand();              // the fitness over x and y
Subcommand report_subcommand();           // recorded runs → a page
Subcommand campaign_merge_subcommand();   // the papers' experiments, runs → one file
Subcommand campaign_report_subcommand();  // that file → a page

}  // namespace gannet::tool
