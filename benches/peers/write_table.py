"""Writes a chain with its resolved constraints for ompl_prm: `write_table.py CHAIN SCENARIO TABLE`."""

import sys

import hop_test

chain, scenario_file, out = sys.argv[1:]
scenario = hop_test.read_scenario(scenario_file)
table = hop_test.chain_table(*hop_test.read_chain(chain), scenario)
with open(out, "w") as file:
    print(table.shape[1], scenario["gravity"], scenario["clearance"], file=file)
    for row in table:
        print(*(repr(float(value)) for value in row), file=file)
