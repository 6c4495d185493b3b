// Smooth minimisation of a function of some hundred variables.
#pragma once

#include <Eigen/Core>

#include <functional>

namespace scan2fea {

// The value at x, infinite where there is none, and else the gradient there.
using Energy = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>;

// The method of Liu and Nocedal, "On the limited memory BFGS method for large scale optimization", 1989, with
// steps that meet the weak conditions of Wolfe: the value never rises, and is finite at the end where it was at the
// start. Ends after `most_steps`, or where a step gains less than a hundred-thousandth. Steps are at most a half at
// first, in the variables' own unit.
void descend(const Energy& energy, Eigen::VectorXd& x, int most_steps);

}  // namespace scan2fea
