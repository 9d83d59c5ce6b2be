#pragma once

namespace saphira::bench {

// CPU time of this process for one cycle of the libraries, without the bus [ms].

double behaviors_10_ms();    ///< 10 behaviors with 5 rules each
double behaviors_1000_ms();  ///< 1,000 behaviors with 5 rules each

/// A delivery as in Figure 10 of the paper: 12 intentions, with reported levels of their behaviors.
double intentions_12_ms();
double intentions_10000_ms();  ///< 10,000 intentions that wait for a condition

}  // namespace saphira::bench
