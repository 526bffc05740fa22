"""Reads every dataset of result files with h5py and xarray: python3 tests/open_files.py FILE.h5 ...

Fails where one has no units or long_name, an axis without a dimension scale, or where xarray sees other dimensions, coordinates, attributes
or values than are stored. Prints one line for each file.
"""

import sys
import warnings

import h5py
import numpy as np
import xarray



def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def is_scale(dataset):
    return h5py.h5ds.is_scale(dataset.id)


def check_dataset(name, dataset):
    """Units, meaning and dimension scales of one dataset; the names of its dimensions."""
    for attribute in ("units", "long_name"):
        assert attribute in dataset.attrs, f"{name} has no {attribute}"
        assert text(dataset.attrs[attribute]).strip(), f"{attribute} of {name} is empty"
    if is_scale(dataset):
        return [name.rsplit("/", 1)[-1]]
    names = []
    for axis, dimension in enumerate(dataset.dims):
        assert len(dimension) == 1, f"axis {axis} of {name} has {len(dimension)} dimension scales"
        scale = dimension[0]
        assert scale.shape == (dataset.shape[axis],), f"axis {axis} of {name} is not as long as {scale.name}"
        names.append(scale.name.rsplit("/", 1)[-1])
    return names


def values_of(dataset):
    values = dataset.asstr()[()] if h5py.check_string_dtype(dataset.dtype) else dataset[()]
    return np.asarray(values)


def same(one, other):
    if one.dtype.kind in "OSU" or other.dtype.kind in "OSU":
        return one.astype(str).tolist() == other.astype(str).tolist()
    return np.array_equal(one, other, equal_nan=one.dtype.kind == "f")


def check_group(path, group, seen):
    """All datasets of one group, as h5py and as xarray see them."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = xarray.open_dataset(path, engine="h5netcdf", group=group.name, decode_times=False)
    for member, dataset in group.items():
        if not isinstance(dataset, h5py.Dataset):
            continue
        name = dataset.name
        dimensions = check_dataset(name, dataset)
        variable = table[member]
        assert list(variable.dims) == dimensions, f"{name}: xarray sees {variable.dims}, stored are {dimensions}"
        assert same(variable.values, values_of(dataset)), f"{name}: xarray reads other values"
        for attribute in ("units", "long_name"):
            assert variable.attrs[attribute] == text(dataset.attrs[attribute]), f"{attribute} of {name}"
        named = text(dataset.attrs.get("coordinates", "")).split()
        for coordinate in named:
            if coordinate in group:
                assert coordinate in variable.coords, f"{name} has not the coordinate {coordinate}"
        if is_scale(dataset) and dataset.dtype.kind == "i":
            assert (np.diff(dataset[()]) > 0).all(), f"{name} does not increase"
        seen.append(name)
    table.close()


def check(path):
    seen = []
    with h5py.File(path, "r") as file:
        for attribute in ("format", "format_version", "program_version", "complete", "title"):
            assert attribute in file.attrs, f"{path} has no attribute {attribute}"
        groups = [file]
        file.visititems(lambda _, it: groups.append(it) if isinstance(it, h5py.Group) else None)
        stored = []
        file.visititems(lambda _, it: stored.append(it.name) if isinstance(it, h5py.Dataset) else None)
        for group in groups:
            check_group(path, group, seen)
        assert sorted(seen) == sorted(stored), f"{path}: not all datasets were looked at"
        print(f"{path}: {text(file.attrs['format'])}, {len(stored)} datasets in {len(groups)} groups")


for file in sys.argv[1:]:
    check(file)
