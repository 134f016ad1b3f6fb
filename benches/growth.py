"""The tables and the plot of `growth.sh`: `growth.py PLOT.svg ROWS SIZES`. A row holds the power of
ten of the triangles, then CPU-seconds, MB and rays of a picture, and the same of one with more
paths. A size holds the pixels across, CPU-seconds and MB by strips, and both as a whole. The plot
is µs a ray over log n, with the line that fits best."""

import sys


def fit(points):
    """Least squares: the line's value at 0 and its slope."""
    n, sx, sy = len(points), sum(x for x, _ in points), sum(y for _, y in points)
    slope = (n * sum(x * y for x, y in points) - sx * sy) / (
        n * sum(x * x for x, _ in points) - sx * sx
    )
    return (sy - slope * sx) / n, slope


def plot(points, start, slope):
    """480 x 300, x from 10^2.5 to 10^7.5, y from 0 to a little above the highest point."""
    top = 1.15 * max(y for _, y in points)
    at = lambda x, y: (60 + (x - 2.5) * 80, 260 - y / top * 240)
    text = lambda x, y, words, anchor="middle": (
        f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}">{words}</text>'
    )
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 480 300" font-family="sans-serif" font-size="12">'
    ]
    parts.append(
        '<rect width="480" height="300" fill="#fff"/><path d="M60 20V260H460" fill="none" stroke="#000"/>'
    )
    for x in range(3, 8):
        parts.append(text(at(x, 0)[0], 278, f'10<tspan dy="-4" font-size="9">{x}</tspan>'))
    for share in (0, 0.25, 0.5, 0.75, 1):
        parts.append(text(54, at(0, share * top)[1] + 4, f"{share * top:.2f}", "end"))
    (x0, y0), (x1, y1) = (at(x, start + slope * x) for x in (points[0][0], points[-1][0]))
    parts.append(
        f'<path d="M{x0:.1f} {y0:.1f}L{x1:.1f} {y1:.1f}" stroke="#888" stroke-dasharray="4"/>'
    )
    parts += [
        f'<circle cx="{at(*point)[0]:.1f}" cy="{at(*point)[1]:.1f}" r="4" fill="#06c"/>'
        for point in points
    ]
    parts += [
        text(260, 296, "triangles"),
        text(66, 16, f"µs a ray; {slope:.2f} µs more for each power of ten", "start"),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def numbers(path):
    return [[float(word) for word in line.split()] for line in open(path)]


def sizes(rows):
    print("The camera scene of the course, one sample per pixel, one thread: CPU-seconds of the")
    print("process and its peak of memory.\n")
    print(
        "| pixels | CPU-s by strips | peak, MB | CPU-s as a whole | peak, MB |\n| --- | --: | --: "
        "| --: | --: |"
    )
    for side, *cells in rows:
        seconds, peak, *whole = [
            f"{cell:.2f}" if k % 2 == 0 else f"{cell:.0f}" for k, cell in enumerate(cells)
        ]
        print(f"| {side:.0f}² | {seconds} | {peak} | " + (" | ".join(whole) or "– | –") + " |")


def main(svg, rows, wide):
    rows = numbers(rows)
    points = [
        (exponent, (more - cpu) / (more_rays - rays) * 1e6)
        for exponent, cpu, _, rays, more, _, more_rays in rows
    ]
    start, slope = fit(points)
    print("One mesh, 256 × 256 pixels, one thread: CPU-seconds from the start of the process to a")
    print(
        "picture of 4 paths per pixel, and the peak of memory. The time of a ray is that of 32 more"
    )
    print("paths per pixel, with shading.\n")
    print(
        "| triangles | CPU-s | peak, MB | bytes a triangle | µs a ray |\n| --- | --: | --: | --: | "
        "--: |"
    )
    for (exponent, cpu, peak, *_), (_, ray) in zip(rows, points):
        count = 10**exponent
        print(
            f"| 10^{exponent:.0f} | {cpu:.2f} | {peak:.0f} | {peak * 2**20 / count:.0f} | "
            f"{ray:.2f} |"
        )
    print("\n![Time of a ray over the number of triangles](growth.svg)\n")
    print(f"The line that fits best is {start:.2f} + {slope:.2f} · log₁₀ n µs.")
    with open(svg, "w") as file:
        file.write(plot(points, start, slope))
    print()
    sizes(numbers(wide))


if __name__ == "__main__":
    main(*sys.argv[1:])
