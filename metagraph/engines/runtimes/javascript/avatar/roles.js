/**
 * Which joint is the left hand: roles of a skeleton, by what VRM says and by names.
 *
 * Names are read as Mixamo, Unreal, Blender (Rigify), 3ds Max (Bip01) and VRoid write them, and as Metagraph's own characters do. The trunk
 * is what lies between the limbs, whatever it is called. Python's `metagraph/motion/roles.py` reads more, and shapes too.
 */

const SIDES = ["left", "right"];
export const ARM = ["upper_arm", "lower_arm", "hand"], LEG = ["upper_leg", "lower_leg", "foot"];
export const FINGERS = ["thumb", "index", "middle", "ring", "little"];
export const TRUNK = ["hips", "spine", "chest", "upper_chest", "neck", "head"];
/** Without these nobody can be moved as a person. */
export const NEEDED = ["hips", "head", ...SIDES.flatMap((side) => [...ARM, ...LEG].map((part) => `${side}_${part}`))];

const SIDE_WORDS = { left: "left", l: "left", right: "right", r: "right" };
const HELPERS = new Set("ik fk pole target ctrl twist roll helper end nub effector aux adj dummy socket mch tweak corrective metacarpal palm".split(" "));
const FACE = new Set("face eye eyes brow eyebrow lid jaw mouth lip teeth tongue nose cheek ear hair".split(" "));
// What a name holds, the words run together; the first that fits counts.
const PARTS = [
  ["lower_arm", /forearm|lowerarm/], ["upper_arm", /upperarm|^arm$/], ["lower_leg", /lowerleg|calf|shin|^leg$/],
  ["upper_leg", /upperleg|upleg|thigh/], ["shoulder", /shoulder|clavicle|collar/], ["hand", /^(bip)?hand$/], ["foot", /^(bip)?foot$/],
  ["toes", /toe|^ball$/],
];
const MARKS = [["thumb", /thumb/], ["index", /index/], ["middle", /middle/], ["little", /little|pinky/], ["ring", /ring/]];

/** Return a name's words without side and digits, its side ("" for neither), and whether it helps others. @param {string} name */
export function readName(name) {
  const bare = name.split(/[:|]/).at(-1).replace(/^mixamorig\d*/, "").replace(/^(J_|Bip\d*\b|DEF-)/, "");
  const words = [];
  let side = "";
  for (const piece of bare.match(/[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+/g) ?? []) {
    const word = piece.toLowerCase();
    if (Object.hasOwn(SIDE_WORDS, word)) side ||= SIDE_WORDS[word];
    else if (!/^\d/.test(word) && !["c", "bip", "f", "sec"].includes(word)) words.push(word);
  }
  return { words, joined: words.join(""), side, helper: words.some((word) => HELPERS.has(word)) };
}

/**
 * Return role -> joint by names: those of `metagraph/motion/roles.py`, and fingers as "left_index_1".
 * @param {string[]} names @param {number[]} parents -1 for none, before their children @returns {Map<string, number>}
 */
export function findRoles(names, parents) {
  const read = names.map(readName);
  const below = names.map(() => 0); // how many joints hang on each
  for (let j = names.length - 1; j >= 0; j--) if (parents[j] >= 0) below[parents[j]] += 1 + below[j];
  const biggest = (joints) => joints.reduce((a, b) => (below[b] > below[a] ? b : a));
  const above = (joint) => {
    const line = [];
    for (let j = joint; j >= 0; j = parents[j]) line.push(j);
    return line;
  };
  const roles = new Map();
  const called = (test) => names.flatMap((_, j) => (test(read[j]) ? [j] : []));
  const limbs = names.map((_, j) => (read[j].helper || !read[j].side ? "" : PARTS.find(([, mark]) => mark.test(read[j].joined))?.[0] ?? ""));
  for (const side of SIDES) {
    for (const [part] of PARTS) {
      const found = names.flatMap((_, j) => (limbs[j] === part && read[j].side === side && !onFinger(read[j]) ? [j] : []));
      if (found.length) roles.set(`${side}_${part}`, biggest(found));
    }
    const hand = roles.get(`${side}_hand`);
    for (const [finger, joints] of hand === undefined ? [] : fingersOf(read, names, (j) => above(j).includes(hand))) {
      joints.slice(0, 3).forEach((joint, n) => roles.set(`${side}_${finger}_${n + 1}`, joint));
    }
    const eyes = called((one) => one.side === side && /eye(ball)?$/.test(one.joined));
    if (eyes.length) roles.set(`${side}_eye`, eyes[0]);
  }
  const jaws = called((one) => one.words.includes("jaw"));
  if (jaws.length) roles.set("jaw", biggest(jaws));
  findTrunk(roles, read, parents, { above, biggest, called, below });
  return roles;
}

const onFinger = ({ joined }) => MARKS.some(([, mark]) => mark.test(joined)) || /finger/.test(joined);

/** Return the joints of each finger of a hand, the nearest to it first. */
function fingersOf(read, names, isBelow) {
  const lines = new Map();
  names.forEach((name, j) => {
    if (read[j].helper || !isBelow(j)) return;
    const numbered = /Finger(\d)/i.exec(name); // of 3ds Max: 0 is the thumb, the digit after it counts along
    const finger = MARKS.find(([, mark]) => mark.test(read[j].joined))?.[0] ?? (numbered && FINGERS[Number(numbered[1])]);
    if (finger) lines.set(finger, [...(lines.get(finger) ?? []), j]);
  });
  return lines;
}

/** Name hips, spine, chest, neck and head, given the limbs. */
function findTrunk(roles, read, parents, { above, biggest, called, below }) {
  const free = (one) => !one.side && !one.helper;
  const common = (joints) => (joints.length ? above(joints[0]).find((j) => joints.every((other) => above(other).includes(j))) : undefined);
  const pair = (part) => SIDES.map((side) => roles.get(`${side}_${part}`)).filter((j) => j !== undefined);
  const over = common(pair("upper_arm"));
  const heads = called((one) => free(one) && one.joined === "head");
  const line = []; // from the arms up
  if (over !== undefined) {
    for (let j = over; j !== undefined; ) {
      const next = parents.flatMap((p, child) => (p === j && free(read[child]) && !read[child].words.some((word) => FACE.has(word)) ? [child] : []));
      j = next.length ? biggest(next) : undefined;
      if (j !== undefined) line.push(j);
    }
  }
  if (heads.length) roles.set("head", biggest(heads));
  else if (line.length) roles.set("head", line.findLast((j) => read[j].joined === read[over].joined) ?? line.at(-1)); // Rigify's spine ends in it
  const head = roles.get("head");
  const ends = [...pair("upper_leg"), ...(head === undefined ? [] : [head])];
  const named = called((one) => free(one) && /^(hips?|pelvis)$/.test(one.joined)).filter((j) => ends.every((end) => above(end).includes(j)));
  const hips = named.length ? named.reduce((a, b) => (below[b] < below[a] ? b : a)) : ends.length > 2 ? common(ends) : undefined;
  if (hips === undefined || hips < 0) return;
  roles.set("hips", hips);
  if (head === undefined || !above(head).includes(hips)) return;
  let between = above(head).slice(1, above(head).indexOf(hips)).reverse().filter((j) => !read[j].helper);
  const neck = between.find((j) => read[j].words.includes("neck")) ?? between.find((j) => over !== undefined && above(j).slice(1).includes(over));
  if (neck !== undefined) {
    roles.set("neck", neck);
    between = between.slice(0, between.indexOf(neck));
  }
  nameSpine(roles, between, (j) => read[j].words.includes("chest"));
}

/** Name the joints between hips and neck, the lowest first, as Python does. */
export function nameSpine(roles, line, isChest = () => false) {
  if (line.length) roles.set("spine", line[0]);
  const rest = line.slice(1);
  if (rest.length === 1) roles.set("chest", rest[0]);
  else if (rest.length) {
    roles.set("upper_chest", rest.at(-1));
    roles.set("chest", rest.slice(0, -1).find(isChest) ?? rest[(rest.length - 1) >> 1]);
  }
}

/**
 * Return role -> node of a glTF as VRM's humanoid says, 0.x or 1.0; null where it is no VRM.
 * @param {object} document the file's JSON @returns {Map<string, number> | null}
 */
export function readHumanoid(document) {
  const { VRM: old, VRMC_vrm: one } = document?.extensions ?? {};
  const listed = one?.humanoid?.humanBones ?? old?.humanoid?.humanBones;
  if (!listed) return null;
  const bones = Array.isArray(listed) ? listed.map(({ bone, node }) => [bone, node]) : Object.entries(listed).map(([bone, { node }]) => [bone, node]);
  const roles = new Map();
  for (const [bone, node] of bones) if (Number.isInteger(node) && node >= 0) roles.set(roleOf(bone, Boolean(one)), node);
  return roles;
}

/** Return the role of a bone of VRM: "leftUpperArm" is "left_upper_arm". The thumb begins a bone lower in 1.0. */
function roleOf(bone, newer) {
  const role = bone.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);
  const found = /^(left|right)_(thumb|index|middle|ring|little)_(metacarpal|proximal|intermediate|distal)$/.exec(role);
  if (!found) return role;
  const [, side, finger, part] = found;
  const order = finger === "thumb" && newer ? ["metacarpal", "proximal", "distal"] : ["proximal", "intermediate", "distal"];
  return `${side}_${finger}_${order.indexOf(part) + 1}`;
}

/**
 * Return role -> joint of an export: what its user said, then what its rigs were computed from, then names.
 * @param {import("../graph.js").Graph} graph
 */
export function rolesOfGraph(graph) {
  const roles = findRoles(graph.joints, graph.parents);
  const { weightRig, contactRig, body } = graph;
  const limb = (side, parts, { upper, lower, hand }, joints) => [upper, lower, hand].forEach((place, n) => roles.set(`${side}_${parts[n]}`, joints[place]));
  SIDES.forEach((side, n) => {
    if (weightRig?.body.arms[n]) limb(side, LEG, weightRig.body.arms[n], weightRig.body.joints); // its limbs are the legs
    if (contactRig?.arms[n]) limb(side, ARM, contactRig.arms[n], contactRig.joints);
    if (body?.eyes[n]?.isJoint) roles.set(`${side}_eye`, body.eyes[n].joint);
  });
  if (weightRig?.bends.length) roles.set("hips", weightRig.body.joints[weightRig.bends[0].place]);
  if (body?.chain.length) roles.set("head", body.chain.at(-1));
  for (const [role, name] of Object.entries(graph.roles)) if (graph.joints.includes(name)) roles.set(role, graph.joints.indexOf(name));
  return roles;
}
