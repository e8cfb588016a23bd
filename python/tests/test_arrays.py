"""Chains and rasters of arrays: against single hops, against the command's maps, and quick."""

import json
import time

import numpy as np
import pytest

import chta

MACHINE = {"hopper": chta.Hopper(5.0, 5.5, clearance_m=0.05), "surface": chta.Surface(0.6), "body": "moon"}


def chain(vertices: int = 401, seed: int = 1) -> chta.Chain:
    random = np.random.default_rng(seed)
    x = np.cumsum(random.uniform(0.2, 2.0, vertices))
    return chta.Chain.from_arrays(x, np.cumsum(random.normal(0, 0.15, vertices)), **MACHINE)


def test_many_pairs_are_single_hops() -> None:
    ground = chain()
    random = np.random.default_rng(2)
    first, last = ground.x_m[0], ground.x_m[-1]
    start = random.uniform(first, last, 3000)
    end = np.clip(start + random.uniform(-25, 25, 3000), first, last)
    hops = ground.takeoff_set(start, end)
    assert 0.1 < hops.feasible.mean() < 0.9
    for i in range(0, 3000, 10):
        one = ground.hop(start[i], end[i])
        assert one["feasible"] == hops.feasible[i]
        if one["feasible"]:
            assert one["takeoff_angle_min_deg"] == pytest.approx(hops.takeoff_angle_min_deg[i], abs=1e-9)
            assert one["takeoff_angle_max_deg"] == pytest.approx(hops.takeoff_angle_max_deg[i], abs=1e-9)
        else:
            assert np.isnan(hops.takeoff_angle_min_deg[i]) and chta.LIMITS[hops.limit[i]]


def test_threads_and_shapes_change_no_bit() -> None:
    ground = chain(seed=3)
    x = np.linspace(ground.x_m[0], ground.x_m[-1], 150)
    square = ground.takeoff_set(x[:, None], x[None, :])
    assert square.limit.shape == (150, 150)
    for threads in (1, 2):
        other = ground.takeoff_set(np.repeat(x, 150), np.tile(x, 150), threads=threads)
        assert np.array_equal(other.takeoff_angle_min_deg, square.takeoff_angle_min_deg.ravel(), equal_nan=True)
        assert np.array_equal(other.limit, square.limit.ravel())
    # From a point to itself there is no direction.
    assert {chta.LIMITS[code] for code in np.diag(square.limit)} == {"direction"}


def test_what_arrays_refuse() -> None:
    ground = chain()
    with pytest.raises(chta.InputError, match="is off the chain"):
        ground.takeoff_set(ground.x_m[0], ground.x_m[-1] + 1)
    with pytest.raises(chta.InputError, match="is off the chain"):
        ground.takeoff_set(np.nan, 5.0)
    with pytest.raises(chta.InputError) as refused:
        chta.Chain.from_arrays([0, 1, 2], [0, 0, 0], cross_slope_deg=[0.0], **MACHINE)
    assert refused.value.key == "cross_slope_deg" and refused.value.found == "1 values"
    with pytest.raises(chta.ScenarioError) as problems:
        chta.Chain.from_arrays([0, 1], [0, 0], hopper={"takeoff_sped_max_m_s": 3}, surface=chta.Surface(0.6), body="moon")
    assert problems.value.problems[0].key == "hopper.takeoff_sped_max_m_s"
    assert "takeoff_speed_max_m_s" in problems.value.problems[0].help
    with pytest.raises(chta.InputError, match="transform"):
        chta.Dem.from_array(np.zeros((4, 4)), (1, 0, 0, 0, 1, 0))


def test_the_map_of_an_array_is_that_of_the_file() -> None:
    path = "data/scenarios/lunar_rille.toml"
    dem = chta.Dem.open("data/terrain/lunar_rille.tif")
    scenario = chta.Scenario.open(path)
    keys = scenario.tables()
    machine = {name: {k: v for k, v in keys[name].items() if v is not None} for name in ("hopper", "surface", "body")}
    machine["hopper"].pop("mass_kg", None)
    of_file = scenario.map(dem="data/terrain/lunar_rille.tif", starts_m=[(60.0, 60.0)], stride=4, back=True)
    again = chta.Dem.from_array(dem.z_m, dem.transform)
    of_array = chta.hop_map(again, (60.0, 60.0), stride=4, **machine)
    assert np.array_equal(of_array.hops, of_file.hops)
    assert of_array.transform == pytest.approx(of_file.grid.transform)
    assert of_file.document()["reachable_posts"] == int((of_file.hops >= 0).sum())
    back = again.hop_map((60.0, 60.0), stride=4, direction="back", **machine)
    assert np.array_equal(back.hops, of_file.grid.hops_back)
    # A hopper that lands faster than it takes off does not get back as it came.
    machine["hopper"]["takeoff_speed_max_m_s"] *= 0.8
    ways = [again.hop_map((60.0, 60.0), stride=4, direction=direction, **machine).hops for direction in ("out", "back")]
    assert not np.array_equal(*ways)


def test_masks_and_single_precision() -> None:
    random = np.random.default_rng(5)
    z = random.normal(0, 0.05, (40, 50)).astype(np.float32)
    masked = np.ma.masked_array(z, mask=np.zeros_like(z, bool))
    masked.mask[10:14, 20:24] = True
    dem = chta.Dem.from_array(masked, (0.5, 0, 100.0, 0, -0.5, 50.0))
    grid = dem.hop_map((100.3, 49.7), **MACHINE)
    assert (grid.hops[10:14, 20:24] == chta.NO_GROUND).all() and grid.hops[0, 0] == 0
    free = chta.mobility(dem, **MACHINE)
    assert np.isnan(free.share[10:14, 20:24]).all() and 0 < np.nanmean(free.share) <= 1
    with pytest.raises(chta.InputError, match="nearest post has an elevation"):
        dem.hop_map((111.0, 44.0), **MACHINE)


def test_a_pair_takes_less_than_ten_microseconds() -> None:
    """The limit is loose, as other work may run beside; `python/README.md` states what was measured."""
    ground = chain()
    random = np.random.default_rng(7)
    start = random.uniform(ground.x_m[0], ground.x_m[-1], 200_000)
    end = np.clip(start + random.uniform(-20, 20, start.size), ground.x_m[0], ground.x_m[-1])
    began = time.process_time()
    ground.takeoff_set(start, end, threads=1)
    assert (time.process_time() - began) / start.size < 10e-6


def test_the_document_of_one_hop_is_plain() -> None:
    ground = chain()
    assert json.dumps(ground.hop(ground.x_m[0], ground.x_m[0] + 1.0))
