// exp and log from additions, multiplications and divisions only. The C library picks variants at
// run time whose last bits differ between machines, and a search amplifies one bit into another
// pose; IEEE arithmetic (and sqrt) is the same everywhere. RT safe.
#pragma once

namespace gannet::search {

// |x| <= 20; relative error below 1e-14.
double exact_exp(double x);

// 1e-6 <= x <= 1e6; absolute error below 1e-14.
double exact_log(double x);

}  // namespace gannet::search
