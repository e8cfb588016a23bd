// OMPL's PRM and PRM* over the same chain, with the same closed-form hop test: prints one line of JSON.
//
//     ompl_prm {first,PRM,PRMstar} TABLE SECONDS SEED
//
// TABLE is what `hop_test.py` makes of a chain and a scenario (see there for its rows), written by `write_table.py`. The state is the place
// along the chain; every place is valid; a motion is valid where one hop, or many along one segment, joins the two places.
//
// A roadmap of OMPL is undirected and a hop is not. Here a pair of places is joined where a hop leads from the one to the other in the
// direction from start to goal, which is the kindest reading: an edge needs one feasible direction only. Every hop of a path is tested
// again in the direction in which the path takes it; `sound` says whether all pass.
//
// `first` stops PRM at its first path. The others have the number of hops as their objective and run until SECONDS are over.

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <vector>

namespace ob = ompl::base;
namespace og = ompl::geometric;

struct Rule {
    double low, high, speed;
};

struct Chain {
    double gravity, clearance;
    std::vector<double> x, z, slope;
    // By direction (forward, reverse) and contact (take-off, landing), then by segment.
    std::vector<Rule> rules[2][2];

    // A place along the chain: its height, the segment to its right, whether it is a vertex.
    struct Place {
        double x, z;
        long segment;
        bool vertex;
    };

    explicit Chain(const char *path) {
        std::ifstream in(path);
        std::size_t n = 0;
        in >> n >> gravity >> clearance;
        for (auto *row : {&x, &z, &slope}) read(in, *row, n);
        for (auto &direction : rules)
            for (auto &contact : direction) {
                std::vector<double> low, high, speed;
                for (auto *row : {&low, &high, &speed}) read(in, *row, n);
                for (std::size_t i = 0; i < n; ++i) contact.push_back({low[i], high[i], speed[i]});
            }
        if (!in) throw std::runtime_error("a table cut short");
    }

    static void read(std::ifstream &in, std::vector<double> &row, std::size_t n) {
        std::string word;
        for (std::size_t i = 0; i < n && in >> word; ++i) row.push_back(std::strtod(word.c_str(), nullptr));
    }

    Place at(double place) const {
        const auto right = std::upper_bound(x.begin(), x.end(), place);
        const long i = std::min<long>(right - x.begin() - 1, static_cast<long>(x.size()) - 1);
        const bool vertex = x[i] == place;
        return {place, vertex ? z[i] : z[i] + slope[i] * (place - x[i]), i, vertex};
    }

    // The hops that join a take-off to a landing: 1, or many along one segment, or 0 where there are none. As `hops_between` of
    // hop_test.py, line by line.
    long hops(double from, double to) const {
        if (from == to) return 0;
        const Place t = at(from), l = at(to);
        const bool forward = l.x > t.x;
        const long last = static_cast<long>(x.size()) - 2;
        const long ruling_t = t.vertex && !forward ? t.segment - 1 : t.segment;
        const long ruling_l = l.vertex && forward ? l.segment - 1 : l.segment;
        if (ruling_t < 0 || ruling_t > last || ruling_l < 0 || ruling_l > last) return 0;
        const Rule &takeoff = rules[forward ? 0 : 1][0][ruling_t];
        const Rule &landing = rules[forward ? 0 : 1][1][ruling_l];
        if (takeoff.speed <= 0.0 || landing.speed <= 0.0) return 0;
        const double run = std::abs(l.x - t.x);
        const Place &left = forward ? t : l, &right = forward ? l : t;
        const long left_of_right = right.vertex ? right.segment - 1 : right.segment;
        const bool shared = left.segment == left_of_right;
        const double b = shared ? (forward ? slope[left.segment] : -slope[left.segment]) : (l.z - t.z) / run;
        const double rise = shared ? b * run : l.z - t.z;
        const double cone_low = std::max(takeoff.low, 2.0 * b - landing.high);
        const double cone_high = std::min(takeoff.high, 2.0 * b - landing.low);
        if (cone_low > cone_high || cone_high <= b) return 0;
        const double v2 = std::min(takeoff.speed * takeoff.speed, landing.speed * landing.speed + 2.0 * gravity * rise);
        const double q = v2 / (gravity * run);
        const double square = q * q - 2.0 * q * b - 1.0;
        if (v2 > 0.0 && square >= 0.0 && q > b) {
            double high = q + std::sqrt(square);
            double low = std::max((1.0 + 2.0 * q * b) / high, cone_low);
            high = std::min(high, cone_high);
            for (long p = left.segment + 1; low <= high && p <= left_of_right; ++p) {
                const double d = std::abs(x[p] - t.x), over = z[p] + clearance;
                const double s = (over - t.z) / d, ahead = (l.z - over) / std::abs(l.x - x[p]);
                low = std::max(low, s + d / run * (s - ahead));
            }
            if (low <= high) return 1;
        }
        if (!shared) return 0;
        const double m = std::min(std::max(b + std::sqrt(1.0 + b * b), cone_low), cone_high);
        const auto reach = [&](double speed, double end) { return 2.0 * speed * speed * (m - b) / (gravity * (1.0 + end * end)); };
        const double farthest = std::min(reach(takeoff.speed, m), reach(landing.speed, 2.0 * b - m));
        return farthest > 0.0 ? static_cast<long>(std::ceil(run / farthest)) : 0;
    }
};

double place(const ob::State *state) { return state->as<ob::RealVectorStateSpace::StateType>()->values[0]; }

// The start is the chain's left end, the goal its right end: towards the goal is towards greater x.
long hops_towards_goal(const Chain &chain, const ob::State *a, const ob::State *b) {
    return chain.hops(std::min(place(a), place(b)), std::max(place(a), place(b)));
}

class HopMotion : public ob::MotionValidator {
  public:
    HopMotion(const ob::SpaceInformationPtr &space, const Chain &chain) : MotionValidator(space), chain_(chain) {}
    bool checkMotion(const ob::State *a, const ob::State *b) const override {
        ++tested;
        return hops_towards_goal(chain_, a, b) > 0;
    }
    bool checkMotion(const ob::State *a, const ob::State *b, std::pair<ob::State *, double> &) const override { return checkMotion(a, b); }
    mutable long tested = 0;

  private:
    const Chain &chain_;
};

class HopCount : public ob::OptimizationObjective {
  public:
    HopCount(const ob::SpaceInformationPtr &space, const Chain &chain) : OptimizationObjective(space), chain_(chain) {
        description_ = "hops";
        setCostThreshold(ob::Cost(0.0));
    }
    ob::Cost stateCost(const ob::State *) const override { return ob::Cost(0.0); }
    ob::Cost motionCost(const ob::State *a, const ob::State *b) const override {
        return ob::Cost(static_cast<double>(std::max(1L, hops_towards_goal(chain_, a, b))));
    }

  private:
    const Chain &chain_;
};

using Clock = std::chrono::steady_clock;

double since(Clock::time_point began) { return std::chrono::duration<double>(Clock::now() - began).count(); }

int main(int count, char **words) {
    if (count != 5) {
        std::cerr << "ompl_prm {first,PRM,PRMstar} TABLE SECONDS SEED\n";
        return 2;
    }
    const std::string how = words[1];
    const double seconds = std::atof(words[3]);
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(std::atol(words[4])));
    const Chain chain(words[2]);

    const auto began = Clock::now();
    const auto line = std::make_shared<ob::RealVectorStateSpace>(1);
    line->setBounds(chain.x.front(), chain.x.back());
    const auto space = std::make_shared<ob::SpaceInformation>(line);
    const auto motion = std::make_shared<HopMotion>(space, chain);
    space->setStateValidityChecker([](const ob::State *) { return true; });
    space->setMotionValidator(motion);
    space->setup();
    const auto problem = std::make_shared<ob::ProblemDefinition>(space);
    ob::ScopedState<ob::RealVectorStateSpace> start(line), goal(line);
    start[0] = chain.x.front();
    goal[0] = chain.x.back();
    problem->setStartAndGoalStates(start, goal);
    if (how != "first") problem->setOptimizationObjective(std::make_shared<HopCount>(space, chain));
    const auto planner = how == "PRMstar" ? std::make_shared<og::PRMstar>(space) : std::make_shared<og::PRM>(space);
    planner->setProblemDefinition(problem);
    planner->setup();
    const auto status = planner->solve(ob::timedPlannerTerminationCondition(seconds));
    const double solve_s = since(began);

    long hops = 0;
    bool sound = true;
    if (status == ob::PlannerStatus::EXACT_SOLUTION) {
        const auto &states = problem->getSolutionPath()->as<og::PathGeometric>()->getStates();
        for (std::size_t i = 0; i + 1 < states.size(); ++i) {
            const long flown = chain.hops(place(states[i]), place(states[i + 1]));
            sound = sound && flown > 0;
            hops += std::max(1L, flown);
        }
    }
    std::printf("{\"hops\": %s, \"solve_s\": %.9f, \"sound\": %s, \"milestones\": %lu, \"motions\": %ld}\n",
                hops > 0 ? std::to_string(hops).c_str() : "null", solve_s, sound ? "true" : "false",
                planner->milestoneCount(), motion->tested);
}
