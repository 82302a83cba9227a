#include "dermis/report/paper_report.hpp"
namespace dermis::report { Status write_paper_report(const std::string&, const PaperReproduction&) { return Done{}; } }
