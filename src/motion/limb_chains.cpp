#include "motion/limb_chains.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/joint_sides.hpp"

namespace mcdbn {
namespace {

/// Chains of both sides may differ by this share of their length, as measured bodies do.
constexpr double kMostDifference = 0.2;

using Chain = std::vector<int>;  ///< joints, each the parent of the next

/// The rest pose and what hangs below each joint.
class Tree {
 public:
  explicit Tree(const Skeleton& skeleton)
      : skeleton_(skeleton), children_(skeleton.joints.size()), reach_(skeleton.joints.size(), 0) {
    for (const Joint& joint : skeleton.joints)
      position_.push_back(joint.parent < 0 ? Eigen::Vector3d(0, 0, 0)
                                           : position_[joint.parent] + joint.offset);
    for (int j = skeleton.joint_count() - 1; j >= 0; --j) {
      for (const Eigen::Vector3d& site : skeleton.joints[j].end_sites)
        reach_[j] = std::max(reach_[j], site.norm());
      const int parent = skeleton.joints[j].parent;
      if (parent < 0) continue;
      children_[parent].insert(children_[parent].begin(), j);
      reach_[parent] = std::max(reach_[parent], reach_[j] + length(j));
    }
  }

  const std::vector<int>& children(int joint) const { return children_[joint]; }
  double length(int joint) const { return skeleton_.joints[joint].offset.norm(); }
  double reach_with_bone(int joint) const { return reach_[joint] + length(joint); }
  const Eigen::Vector3d& position(int joint) const { return position_[joint]; }
  const std::string& name(int joint) const { return skeleton_.joints[joint].name; }

  /// From the joint down, along the longest way.
  Chain longest_chain(int joint) const {
    Chain chain{joint};
    while (!children_[chain.back()].empty())
      chain.push_back(*std::ranges::max_element(children_[chain.back()], {},
                                                [&](int child) { return reach_with_bone(child); }));
    return chain;
  }

 private:
  const Skeleton& skeleton_;
  std::vector<std::vector<int>> children_;
  std::vector<double> reach_;
  std::vector<Eigen::Vector3d> position_;
};

bool alike(const Tree& tree, const Chain& a, const Chain& b) {
  if (a.size() != b.size()) return false;
  double difference = 0, whole = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference += std::abs(tree.length(a[k]) - tree.length(b[k]));
    whole += tree.length(a[k]);
  }
  return whole > 0 && difference <= kMostDifference * whole;
}

/// The two like chains of three joints or more that hang from the joint and reach farthest.
std::optional<std::pair<Chain, Chain>> limb_pair(const Tree& tree, int joint) {
  std::optional<std::pair<Chain, Chain>> best;
  const std::vector<int>& children = tree.children(joint);
  for (auto a = children.begin(); a != children.end(); ++a) {
    for (auto b = std::next(a); b != children.end(); ++b) {
      std::pair pair{tree.longest_chain(*a), tree.longest_chain(*b)};
      if (pair.first.size() < 3 || !alike(tree, pair.first, pair.second)) continue;
      if (!best || tree.reach_with_bone(*a) > tree.reach_with_bone(best->first.front()))
        best = std::move(pair);
    }
  }
  return best;
}

/// The limb in a chain. Its longest bone is the upper of two unless what follows is no longer than
/// a hand or a foot; the bone that leads to the chain's first joint does not count.
LimbChain limb_of(const Tree& tree, const Chain& chain) {
  constexpr double kHandOfForearm = 0.6;  // 0.5 to 0.58 by anthropometry; forearms are 0.69 or more
  const auto longest = std::ranges::max_element(chain.begin() + 1, chain.end(), {},
                                                [&](int joint) { return tree.length(joint); });
  auto best = static_cast<std::size_t>(longest - chain.begin());
  const bool lower = best + 1 == chain.size() ||
                     tree.length(chain[best + 1]) < kHandOfForearm * tree.length(chain[best]);
  if (lower) best = std::max<std::size_t>(1, best - 1);
  LimbChain limb{.first = chain[best - 1], .middle = chain[best], .end = chain[best + 1]};
  if (best >= 2) limb.girdle = chain[best - 2];
  for (std::size_t k = best + 2; k < chain.size() && limb.tip < 0; ++k)
    if (tree.length(chain[k]) > 0) limb.tip = chain[k];
  return limb;
}

/// Left first: by marks in the names, else by the rest pose.
std::array<LimbChain, 2> in_order(const Tree& tree, std::array<LimbChain, 2> limbs,
                                  const Eigen::Vector3d& left) {
  const Side side = side_of(tree.name(limbs[0].middle));
  const Side other = side_of(tree.name(limbs[1].middle));
  const auto leftness = [&](const LimbChain& limb) {
    return left.dot(tree.position(limb.first) + tree.position(limb.middle));
  };
  const bool swapped = side != other && side != Side::middle && other != Side::middle
                           ? side == Side::right
                           : leftness(limbs[0]) < leftness(limbs[1]);
  if (swapped) std::swap(limbs[0], limbs[1]);
  return limbs;
}

std::array<LimbChain, 2> limbs_of(const Tree& tree, const std::pair<Chain, Chain>& pair) {
  return {limb_of(tree, pair.first), limb_of(tree, pair.second)};
}

Eigen::Vector3d centre(const Tree& tree, const std::array<LimbChain, 2>& limbs,
                       int LimbChain::*joint) {
  return 0.5 * (tree.position(limbs[0].*joint) + tree.position(limbs[1].*joint));
}

/// The body's left in the rest pose.
Eigen::Vector3d leftward(const Tree& tree, const std::array<LimbChain, 2>& legs,
                         const std::array<LimbChain, 2>& arms) {
  const Eigen::Vector3d up =
      centre(tree, arms, &LimbChain::first) - centre(tree, legs, &LimbChain::end);
  Eigen::Vector3d forward(0, 0, 1);  // as files usually face
  if (legs[0].tip >= 0)
    forward = centre(tree, legs, &LimbChain::tip) - centre(tree, legs, &LimbChain::end);
  return up.cross(forward);
}

}  // namespace

BodyChains body_chains(const Skeleton& skeleton) {
  BodyChains body;
  const Tree tree(skeleton);
  std::optional<std::pair<Chain, Chain>> legs, arms;
  std::vector<int> above;  // children of the pelvis that are no legs, and all below them
  for (int j = 0; j < skeleton.joint_count() && !legs; ++j)
    if ((legs = limb_pair(tree, j))) body.pelvis = j;
  if (!legs) return body;
  std::vector<bool> in_trunk(skeleton.joints.size(), false);
  for (int j = body.pelvis + 1; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.joints[j].parent;
    in_trunk[j] = j != legs->first.front() && j != legs->second.front() && parent >= 0 &&
                  (parent == body.pelvis || in_trunk[parent]);
    if (!in_trunk[j]) continue;
    auto pair = limb_pair(tree, j);
    const bool longer = pair && (!arms || tree.reach_with_bone(pair->first.front()) >
                                              tree.reach_with_bone(arms->first.front()));
    if (!longer) continue;
    arms = std::move(pair);
    body.chest = j;
  }
  if (!arms) return body;
  const auto both_legs = limbs_of(tree, *legs), both_arms = limbs_of(tree, *arms);
  const Eigen::Vector3d left = leftward(tree, both_legs, both_arms);
  body.legs = in_order(tree, both_legs, left);
  body.arms = in_order(tree, both_arms, left);
  int neck = -1;
  for (const int child : tree.children(body.chest))
    if (child != arms->first.front() && child != arms->second.front() &&
        (neck < 0 || tree.reach_with_bone(child) > tree.reach_with_bone(neck)))
      neck = child;
  if (neck < 0) return body;
  const Chain chain = tree.longest_chain(neck);
  body.head = chain.back();
  if (chain.size() > 1) body.neck = neck;
  return body;
}

}  // namespace mcdbn
