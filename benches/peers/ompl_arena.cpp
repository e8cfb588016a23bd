// OMPL's RRT* over an arena of boxes, by the rules of chta's: prints one line of JSON.
//
//     ompl_arena ARENA SECONDS RANGE_M GOAL_BIAS SEED
//
// ARENA is what `arena_run.py` makes of an arena of chta: size, start, goal, speed, time of a jump, greatest rise, ring, longest jump, the number
// of boxes, and for each its least and greatest x and y and its height. A state is a place on the floor, valid where no face is within the ring.
// A motion drives at one height clear of all rings, jumps up over one face, or drops over faces. It takes its length at the driving speed, and a
// jump its time as well.

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <vector>

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double SAME_M = 1e-9;

struct Arena {
    std::array<double, 2> size, start, goal;
    double speed, jump_s, rise, ring, longest;
    std::vector<std::array<double, 5>> boxes;
    // The coordinates of faces, and the open rectangles that nothing drives through.
    std::array<std::vector<double>, 2> lines;
    std::vector<std::array<double, 4>> rings;

    explicit Arena(const char *path) {
        std::ifstream in(path);
        std::size_t count = 0;
        in >> size[0] >> size[1] >> start[0] >> start[1] >> goal[0] >> goal[1] >> speed >> jump_s >> rise >> ring >> longest >> count;
        boxes.resize(count);
        for (auto &box : boxes) in >> box[0] >> box[1] >> box[2] >> box[3] >> box[4];
        if (!in) throw std::runtime_error("an arena cut short");
        for (int axis = 0; axis < 2; ++axis) {
            auto &of = lines[axis];
            for (const auto &box : boxes) of.insert(of.end(), {box[axis], box[2 + axis]});
            std::sort(of.begin(), of.end());
            of.erase(std::unique(of.begin(), of.end()), of.end());
        }
        // Each piece of a line between two lines of the other axis has one height on either side.
        const double grow = ring - SAME_M;
        for (int axis = 0; axis < 2; ++axis)
            for (const double at : lines[axis])
                for (std::size_t i = 0; i + 1 < lines[1 - axis].size(); ++i) {
                    const double low = lines[1 - axis][i], high = lines[1 - axis][i + 1], middle = 0.5 * (low + high);
                    const auto side = [&](double off) { return axis == 0 ? height(at + off, middle) : height(middle, at + off); };
                    if (side(-1e-6) == side(1e-6)) continue;
                    if (axis == 0) rings.push_back({at - grow, low - grow, at + grow, high + grow});
                    else rings.push_back({low - grow, at - grow, high + grow, at + grow});
                }
    }

    double height(double x, double y) const {
        double top = 0.0;
        for (const auto &box : boxes)
            if (box[0] <= x && x <= box[2] && box[1] <= y && y <= box[3]) top = std::max(top, box[4]);
        return top;
    }

    bool valid(double x, double y) const {
        return std::none_of(rings.begin(), rings.end(),
                            [&](const auto &r) { return r[0] < x && x < r[2] && r[1] < y && y < r[3]; });
    }

    static bool passes(const std::array<double, 4> &r, const double *a, const double *b) {
        if (std::max(a[0], b[0]) <= r[0] || std::min(a[0], b[0]) >= r[2] || std::max(a[1], b[1]) <= r[1] || std::min(a[1], b[1]) >= r[3])
            return false;
        const double dx = b[0] - a[0], dy = b[1] - a[1];
        const auto side = [&](double x, double y) { return dx * (y - a[1]) - dy * (x - a[0]); };
        const std::array<double, 4> s{side(r[0], r[1]), side(r[2], r[1]), side(r[2], r[3]), side(r[0], r[3])};
        const bool left = std::all_of(s.begin(), s.end(), [](double v) { return v >= 0.0; });
        return !left && !std::all_of(s.begin(), s.end(), [](double v) { return v <= 0.0; });
    }

    bool joined(const double *a, const double *b) const {
        const double from = height(a[0], a[1]), to = height(b[0], b[1]);
        if (from == to)
            return std::none_of(rings.begin(), rings.end(), [&](const auto &r) { return passes(r, a, b); });
        if (std::hypot(b[0] - a[0], b[1] - a[1]) > longest || to - from > rise + SAME_M) return false;
        // The heights between the crossings of lines, in order.
        std::vector<double> at{0.0, 1.0};
        for (int axis = 0; axis < 2; ++axis)
            for (const double line : lines[axis]) {
                const double share = (line - a[axis]) / (b[axis] - a[axis]);
                if (share > 0.0 && share < 1.0) at.push_back(share);
            }
        std::sort(at.begin(), at.end());
        double now = from;
        for (std::size_t i = 0; i + 1 < at.size(); ++i) {
            const double middle = 0.5 * (at[i] + at[i + 1]);
            const double next = height(a[0] + middle * (b[0] - a[0]), a[1] + middle * (b[1] - a[1]));
            if (next == now) continue;
            if (to > from ? now != from || next != to : next > now) return false;
            now = next;
        }
        return true;
    }

    double time(const double *a, const double *b) const {
        return std::hypot(b[0] - a[0], b[1] - a[1]) / speed + (height(b[0], b[1]) > height(a[0], a[1]) ? jump_s : 0.0);
    }
};

const double *values(const ob::State *state) { return state->as<ob::RealVectorStateSpace::StateType>()->values; }

class Motion : public ob::MotionValidator {
  public:
    Motion(const ob::SpaceInformationPtr &space, const Arena &arena) : MotionValidator(space), arena_(arena) {}
    bool checkMotion(const ob::State *a, const ob::State *b) const override { return arena_.joined(values(a), values(b)); }
    bool checkMotion(const ob::State *a, const ob::State *b, std::pair<ob::State *, double> &last) const override {
        last.second = 0.0;
        return checkMotion(a, b);
    }

  private:
    const Arena &arena_;
};

class PathTime : public ob::OptimizationObjective {
  public:
    PathTime(const ob::SpaceInformationPtr &space, const Arena &arena) : OptimizationObjective(space), arena_(arena) {
        description_ = "path time";
        setCostThreshold(ob::Cost(0.0));
    }
    ob::Cost stateCost(const ob::State *) const override { return ob::Cost(0.0); }
    ob::Cost motionCost(const ob::State *a, const ob::State *b) const override { return ob::Cost(arena_.time(values(a), values(b))); }
    ob::Cost motionCostHeuristic(const ob::State *a, const ob::State *b) const override {
        return ob::Cost(std::hypot(values(b)[0] - values(a)[0], values(b)[1] - values(a)[1]) / arena_.speed);
    }

  private:
    const Arena &arena_;
};

int main(int count, char **words) {
    if (count != 6) {
        std::cerr << "ompl_arena ARENA SECONDS RANGE_M GOAL_BIAS SEED\n";
        return 2;
    }
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(std::atol(words[5])));
    const Arena arena(words[1]);
    const auto floor = std::make_shared<ob::RealVectorStateSpace>(2);
    ob::RealVectorBounds bounds(2);
    for (int axis = 0; axis < 2; ++axis) {
        bounds.setLow(axis, 0.0);
        bounds.setHigh(axis, arena.size[axis]);
    }
    floor->setBounds(bounds);
    const auto space = std::make_shared<ob::SpaceInformation>(floor);
    space->setStateValidityChecker([&](const ob::State *at) { return arena.valid(values(at)[0], values(at)[1]); });
    space->setMotionValidator(std::make_shared<Motion>(space, arena));
    space->setup();
    const auto problem = std::make_shared<ob::ProblemDefinition>(space);
    ob::ScopedState<ob::RealVectorStateSpace> start(floor), goal(floor);
    for (int axis = 0; axis < 2; ++axis) {
        start[axis] = arena.start[axis];
        goal[axis] = arena.goal[axis];
    }
    problem->setStartAndGoalStates(start, goal);
    problem->setOptimizationObjective(std::make_shared<PathTime>(space, arena));
    const auto planner = std::make_shared<og::RRTstar>(space);
    planner->setRange(std::atof(words[3]));
    planner->setGoalBias(std::atof(words[4]));
    planner->setProblemDefinition(problem);
    planner->setup();
    const auto began = std::chrono::steady_clock::now();
    const auto status = planner->solve(ob::timedPlannerTerminationCondition(std::atof(words[2])));
    const double solve_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    double time = 0.0;
    const bool solved = status == ob::PlannerStatus::EXACT_SOLUTION;
    if (solved) {
        const auto &states = problem->getSolutionPath()->as<og::PathGeometric>()->getStates();
        for (std::size_t i = 0; i + 1 < states.size(); ++i) {
            if (!arena.joined(values(states[i]), values(states[i + 1]))) throw std::runtime_error("a motion of the path is not valid");
            time += arena.time(values(states[i]), values(states[i + 1]));
        }
    }
    std::printf("{\"solved\": %s, \"path_time_s\": %.6f, \"solve_s\": %.4f}\n", solved ? "true" : "false", time, solve_s);
    return 0;
}
