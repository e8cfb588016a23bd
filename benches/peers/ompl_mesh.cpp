// OMPL's PRM over the contacts of a roadmap of chta, with the arc length of a hop as the cost: prints one line of JSON.
//
//     ompl_mesh {PRM,PRMstar} TABLE SECONDS NEIGHBOURS SEED
//
// TABLE is what `mesh_run.py` makes of a roadmap: the number of contacts, of hops, of the start and of the goal, a line with the position of
// each contact, and a line for each hop with both contacts and the length of its shortest arc. A state is a contact, its place that of the
// contact; a motion is valid where the table has a hop between the two in either direction. OMPL thus does not compute hops: it looks them up.
//
// NEIGHBOURS is the number of nearest nodes to which PRM joins a new one (0: its own rule).

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace ob = ompl::base;
namespace og = ompl::geometric;

struct Table {
    std::vector<std::array<double, 3>> at;
    // Of each contact: the others that a hop joins to it, with the length of the arc.
    std::vector<std::unordered_map<long, float>> hops;
    long start, goal;

    explicit Table(const char *path) {
        std::ifstream in(path);
        std::size_t contacts = 0, count = 0;
        in >> contacts >> count >> start >> goal;
        at.resize(contacts);
        hops.resize(contacts);
        for (auto &point : at) in >> point[0] >> point[1] >> point[2];
        for (std::size_t i = 0; i < count; ++i) {
            long from = 0, to = 0;
            float length = 0;
            in >> from >> to >> length;
            for (const auto &[a, b] : {std::pair{from, to}, std::pair{to, from}}) {
                const auto known = hops[a].find(b);
                if (known == hops[a].end() || known->second > length) hops[a][b] = length;
            }
        }
        if (!in) throw std::runtime_error("a table cut short");
    }

    // The length of the hop between two contacts; negative without one.
    double length(long from, long to) const {
        const auto found = hops[from].find(to);
        return found == hops[from].end() ? -1.0 : found->second;
    }
};

// The place of a state is its contact's; the fourth coordinate is the number of the contact, which no distance counts.
class ContactSpace : public ob::RealVectorStateSpace {
  public:
    ContactSpace() : RealVectorStateSpace(4) {}
    double distance(const ob::State *a, const ob::State *b) const override {
        const double *p = a->as<StateType>()->values, *q = b->as<StateType>()->values;
        return std::sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
    }
};

long number(const ob::State *state) { return std::lround(state->as<ob::RealVectorStateSpace::StateType>()->values[3]); }

void place(const Table &table, long contact, double *values) {
    for (int i = 0; i < 3; ++i) values[i] = table.at[contact][i];
    values[3] = static_cast<double>(contact);
}

class ContactSampler : public ob::StateSampler {
  public:
    ContactSampler(const ob::StateSpace *space, const Table &table) : StateSampler(space), table_(table), order_(table.at.size()) {
        std::iota(order_.begin(), order_.end(), 0L);
    }
    // Every contact once, in random order, and then again.
    void sampleUniform(ob::State *state) override {
        if (drawn_ == order_.size()) drawn_ = 0;
        if (drawn_ == 0) rng_.shuffle(order_.begin(), order_.end());
        place(table_, order_[drawn_++], state->as<ob::RealVectorStateSpace::StateType>()->values);
    }
    void sampleUniformNear(ob::State *state, const ob::State *, double) override { sampleUniform(state); }
    void sampleGaussian(ob::State *state, const ob::State *, double) override { sampleUniform(state); }

  private:
    const Table &table_;
    std::vector<long> order_;
    std::size_t drawn_ = 0;
};

class HopMotion : public ob::MotionValidator {
  public:
    HopMotion(const ob::SpaceInformationPtr &space, const Table &table) : MotionValidator(space), table_(table) {}
    bool checkMotion(const ob::State *a, const ob::State *b) const override { return table_.length(number(a), number(b)) >= 0.0; }
    bool checkMotion(const ob::State *a, const ob::State *b, std::pair<ob::State *, double> &last) const override {
        // No part of a hop is valid by itself.
        last.second = 0.0;
        return checkMotion(a, b);
    }

  private:
    const Table &table_;
};

class ArcLength : public ob::OptimizationObjective {
  public:
    ArcLength(const ob::SpaceInformationPtr &space, const Table &table) : OptimizationObjective(space), table_(table) {
        description_ = "arc length";
        setCostThreshold(ob::Cost(0.0));
    }
    ob::Cost stateCost(const ob::State *) const override { return ob::Cost(0.0); }
    ob::Cost motionCost(const ob::State *a, const ob::State *b) const override {
        return ob::Cost(std::max(0.0, table_.length(number(a), number(b))));
    }

  private:
    const Table &table_;
};

int main(int count, char **words) {
    if (count != 6) {
        std::cerr << "ompl_mesh {PRM,PRMstar} TABLE SECONDS NEIGHBOURS SEED\n";
        return 2;
    }
    const std::string how = words[1];
    const double seconds = std::atof(words[3]);
    const unsigned neighbours = static_cast<unsigned>(std::atol(words[4]));
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(std::atol(words[5])));
    const Table table(words[2]);

    const auto contacts = std::make_shared<ContactSpace>();
    contacts->setBounds(-1e9, 1e9);
    contacts->setStateSamplerAllocator([&](const ob::StateSpace *space) { return std::make_shared<ContactSampler>(space, table); });
    const auto space = std::make_shared<ob::SpaceInformation>(contacts);
    space->setStateValidityChecker([](const ob::State *) { return true; });
    space->setMotionValidator(std::make_shared<HopMotion>(space, table));
    space->setup();
    const auto problem = std::make_shared<ob::ProblemDefinition>(space);
    ob::ScopedState<ob::RealVectorStateSpace> start(contacts), goal(contacts);
    place(table, table.start, start->values);
    place(table, table.goal, goal->values);
    problem->setStartAndGoalStates(start, goal);
    problem->setOptimizationObjective(std::make_shared<ArcLength>(space, table));
    const auto planner = how == "PRMstar" ? std::make_shared<og::PRMstar>(space) : std::make_shared<og::PRM>(space);
    if (neighbours > 0) planner->setMaxNearestNeighbors(neighbours);
    planner->setProblemDefinition(problem);
    planner->setup();
    const auto began = std::chrono::steady_clock::now();
    const auto status = planner->solve(ob::timedPlannerTerminationCondition(seconds));
    const double solve_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();

    double length = 0.0;
    long hops = 0;
    const bool solved = status == ob::PlannerStatus::EXACT_SOLUTION;
    if (solved) {
        const auto &states = problem->getSolutionPath()->as<og::PathGeometric>()->getStates();
        for (std::size_t i = 0; i + 1 < states.size(); ++i, ++hops) length += table.length(number(states[i]), number(states[i + 1]));
    }
    std::printf("{\"solved\": %s, \"length_m\": %.4f, \"hops\": %ld, \"nodes\": %lu, \"edges\": %lu, \"solve_s\": %.3f}\n",
                solved ? "true" : "false", length, hops, planner->milestoneCount(), planner->edgeCount(), solve_s);
    return 0;
}
