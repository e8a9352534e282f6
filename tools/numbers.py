"""Counts the numbers of the core that are no settings, and type names that stand for two things.

    python tools/numbers.py             # the counts
    python tools/numbers.py --list      # and where each stands
    python tools/numbers.py --names     # and the names with more than one meaning

What counts: numbers_outside_settings.py.
"""

import argparse

from numbers_outside_settings import counts, places, type_names


def main() -> None:
    """Print the counts."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--list", action="store_true", help="where each literal stands")
    parser.add_argument("--names", action="store_true", help="which names mean two things")
    options = parser.parse_args()
    print("\n".join(counts()))
    if options.list:
        print("\n".join(places()))
    if options.names:
        for name, found in type_names().items():
            print(f"{name}: {', '.join(found)}")


if __name__ == "__main__":
    main()
