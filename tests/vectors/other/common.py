"""What the scripts of this folder share: vectors, and how far a wrong number is from the right one."""
import json
import pathlib

from mpmath import mp, mpf

mp.dps = 30


class File:
    """One file of vectors. `tell` holds what the file says of itself."""
    def __init__(self, name, **tell):
        self.name, self.tell, self.vectors = name, tell, []

    def add(self, kind, vector, wrong):
        """`wrong` maps JSON pointers of expected numbers to ten of their tolerances."""
        self.vectors.append({'id': f'other {kind} {len(self.vectors)}', 'kind': kind, **vector, 'wrong': wrong})

    def write(self):
        text = json.dumps({**self.tell, 'vectors': '@'}).replace('"@"', '[\n' + ',\n'.join(line(v) for v in self.vectors) + '\n]')
        pathlib.Path(__file__).with_name(f'{self.name}.json').write_text(text + '\n')


def line(vector):
    return json.dumps(vector, default=lambda x: float(x) if isinstance(x, mpf) else x.item() if x.ndim == 0 else x.tolist())


def at(value, pointer):
    for key in pointer.split('/')[1:]:
        value = value[int(key)] if isinstance(value, list) else value[key]
    return float(value)


def relative(vector, tolerance, *pointers):
    """Ten tolerances of numbers that are compared relatively."""
    return {p: 10 * tolerance * abs(at(vector, p)) for p in pointers}


def absolute(tolerance, *pointers):
    return {p: 10 * tolerance for p in pointers}
