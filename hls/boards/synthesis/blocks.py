"""Places of a board's multipliers and block RAMs, given to nextpnr before it places the rest.

An ECP5-85F has these blocks in a few rows, and a board of ours uses nearly all multipliers. nextpnr's static
placer moves them freely and then takes for each a place that is left, which throws many of them across the
device and doubles the length of all wires (docs/decisions/0044-data-that-stays.md). Here blocks that few cells lie
between get places beside each other, by simulated annealing over pairs that change places.
"""

import json
import math
import random
from collections import Counter

COLUMNS = (*range(4, 59, 9), *range(69, 115, 9))  # in which there are four blocks of a row
# Kind: the sites of an ECP5-85F, each a column, a row and a name.
SITES = {
    "MULT18X18D": [(x + step, y, f"MULT18_{step}") for y in (10, 34, 58) for x in COLUMNS for step in (0, 1, 4, 5)],
    "DP16KD": [(x + 2 * step, y, f"EBR{step}") for y in (22, 46, 70, 82) for x in COLUMNS for step in range(4)],
}
# Nets with more pins than this are control, which is everywhere.
MOST_PINS = 24
# Cells between two blocks beyond which they do not matter to each other.
REACH = 20
# As many others draw a block at most.
STRONGEST = 12
HEAT, COOLING = 0.3, 5.0  # at first, of a usual change; the logarithm of how much colder it is at last
STEPS = 1_500_000


def neighbours(cells):
    """[the numbers of the cells that share a net with it] for each of the cells, but for large nets."""
    pins = {}
    for number, cell in enumerate(cells):
        for bits in cell["connections"].values():
            for net in bits:
                if isinstance(net, int):
                    pins.setdefault(net, []).append(number)
    found = [[] for _ in cells]
    for numbers in pins.values():
        if len(numbers) <= MOST_PINS:
            for number in numbers:
                found[number].extend(numbers)
    return [sorted(set(numbers)) for numbers in found]


def affinities(cells, chosen):
    """[{place in `chosen`: how strongly the two are drawn together}] for each of the chosen cells: many short ways
    draw strongly. Ways do not go through a chosen cell."""
    joined = neighbours(cells)
    place = {number: index for index, number in enumerate(chosen)}
    drawn = [Counter() for _ in chosen]
    for index, start in enumerate(chosen):
        ways, seen = {start: 1.0}, {start}
        for distance in range(1, REACH + 1):
            reached = Counter()
            for number, share in ways.items():
                onward = [each for each in joined[number] if each not in seen]
                for each in onward:
                    reached[each] += share / len(onward)
            seen.update(reached)
            for number in [each for each in reached if each in place]:
                share = reached.pop(number) / distance
                drawn[index][place[number]] += share
                drawn[place[number]][index] += share
            ways = reached
    return both_ways([balanced(pulls) for pulls in drawn])


def balanced(pulls):
    """The strongest pulls, all of them together as strong as those of every other block."""
    strongest = pulls.most_common(STRONGEST)
    return {each: pull / sum(pull for _, pull in strongest) for each, pull in strongest}


def both_ways(drawn):
    """The pulls of each block and those of the others towards it."""
    found = [Counter(pulls) for pulls in drawn]
    for a, pulls in enumerate(drawn):
        for b, pull in pulls.items():
            found[b][a] += pull
    return found


def length(drawn, sites):
    """The length of all ways with these sites, each as strong as it draws."""
    return sum(pull * (abs(sites[a][0] - sites[b][0]) + abs(sites[a][1] - sites[b][1]))
               for a, pulls in enumerate(drawn) for b, pull in pulls.items()) / 2


def assign(drawn, kinds, sites, seed, steps=STEPS):
    """A site for each block, of those of its kind. `kinds` are the blocks' kinds."""
    chance = random.Random(seed)
    # Places of all kinds, one after the other; those of a kind begin with its blocks' and end with free ones.
    places, slots, ranges = [], [0] * len(kinds), []
    for kind, of_kind in sites.items():
        blocks = [number for number, each in enumerate(kinds) if each == kind]
        first = len(places)
        for slot, number in enumerate(blocks, first):
            slots[number] = slot
        places += chance.sample(of_kind, len(of_kind))
        ranges += [(first, len(places))] * len(blocks)
    pulls = [[] for _ in places]
    for number, each in enumerate(drawn):
        pulls[slots[number]] = [(slots[other], pull) for other, pull in each.items()]
    movable = sorted(slots)

    def cost(slot, site, other):
        x, y, _ = site
        return sum(pull * (abs(x - places[b][0]) + abs(y - places[b][1])) for b, pull in pulls[slot] if b != other)

    usual = []
    for step in range(steps):
        which = chance.randrange(len(movable))
        a, b = movable[which], chance.randrange(*ranges[which])
        if a == b:
            continue
        change = (cost(a, places[b], b) - cost(a, places[a], b)) + (cost(b, places[a], a) - cost(b, places[b], a))
        if step < 500:
            usual.append(abs(change))
            continue
        warmth = HEAT * sum(usual) / len(usual) * math.exp(-COOLING * step / steps)
        if change <= 0 or chance.random() < math.exp(-change / warmth):
            places[a], places[b] = places[b], places[a]
    return [places[slot] for slot in slots]


def with_places(text, seed):
    """A netlist of Yosys, in JSON, with places for its blocks."""
    netlist = json.loads(text)
    (top,) = [module for module in netlist["modules"].values() if "top" in module["attributes"]]
    cells = list(top["cells"].values())
    chosen = [number for number, cell in enumerate(cells) if cell["type"] in SITES]
    kinds = [cells[number]["type"] for number in chosen]
    for number, (x, y, name) in zip(chosen, assign(affinities(cells, chosen), kinds, SITES, seed)):
        cells[number]["attributes"]["BEL"] = f"X{x}/Y{y}/{name}"
    return json.dumps(netlist)
