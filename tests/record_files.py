"""Record files in each format, written from the description of the format."""

import numpy as np


def block(values, form, per_line):
    """Numbers in columns, the last line being shorter."""
    texts = [format(value, form) for value in values]
    return ["".join(texts[k : k + per_line]) for k in range(0, len(texts), per_line)]


def peer(samples, step=0.01, *, old=False, title="ACCELERATION TIME SERIES IN UNITS OF G"):
    fourth = (
        f"{len(samples)}    {step:.4f}    NPTS, DT"
        if old
        else f"NPTS=  {len(samples)}, DT=   {step:.4f} SEC,"
    )
    header = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        "Valley-02, 1/2/1940, Town Array #9, 180",
        title,
        fourth,
    ]
    return [*header, *block(samples, "15.7E", 5)]


def smc(samples, step=0.005, comments=2):
    text = ["2 CORRECTED ACCELEROGRAM", "*", "XYZ", "     1989  10  18    0004 Valley", "Moment Mag=  7.1"]
    text += ["station = Town, 12 Street, F component=    360", *["*"] * 5]
    integers = [-32768] * 48
    integers[15], integers[16] = comments, len(samples)
    reals = [1.7e38] * 50
    reals[1], reals[29], reals[31] = 1 / step, max(samples), min(samples)
    tables = block(integers, "10d", 8) + block(reals, "15.7E", 5)
    return [*text, *tables, *["| comment 1 2 3"] * comments, *block(samples, "10.3f", 8)]


def csmip_v1(channels, rate=100, unit="g"):
    lines = []
    for number, samples in enumerate(channels, 1):
        peak = max(samples, key=abs)
        lines += [
            "Uncorrected Accelerogram Data             Processed: 07/06/19",
            *["Rcrd of Fri Jul  5, 2019"] * 4,
        ]
        lines += ["Town, Street Rd.     NETW   Data: Acceleration", f"Chan  {number}:  {90 * number} Deg   "]
        lines += ["Rcrd of Fri Jul  5, 2019", "Hypocenter:  To be determined.", "Instr Period =  .0050 sec"]
        lines += [
            "No. of Points",
            f"Units of uncor data are sec and {unit}.   Max  =  {peak:.3f} {unit}, at   1. sec.",
            "",
        ]
        lines += block([-999] * 100, "5d", 16) + block([-999.0] * 50, "10.3f", 8)
        lines += [
            f" {len(samples)} Accelerogram points at {rate} pts/sec in units of {unit}.       Format: (8f9.6)  "
        ]
        lines += [
            *block(samples, "9.6f", 8),
            f"/&  ----------  End of Data for Station Channel   {number}  ----------",
        ]
    return lines


def csmip_v2(channels, step=0.02, announce="{} POINTS OF {} DATA EQUALLY SPACED AT {:.3f} SEC. (UNITS: {})"):
    lines = []
    for number, samples in enumerate(channels, 1):
        peak = max(samples, key=abs)
        lines += [f"CORRECTED ACCELEROGRAM   12345-S1       CHAN  {number}:  {90 * number} DEG     FROM"]
        lines += ["UNCORRECTED ACCELEROGRAM DATA", *["VALLEY EARTHQUAKE"] * 4, "TOWN FAULT ZONE 14    "]
        lines += [f"CHAN  {number}:  {90 * number} DEG", "UNCOR MAX  =  -.275 G", *["HEADER"] * 6]
        lines += [f" {len(samples)} POINTS OF INSTRUMENT- AND BASELINE-CORRECTED ACCEL, VELOC AND DISPL DATA"]
        lines += [
            "AT EQUALLY-SPACED INTERVALS",
            f"PEAK ACCELERATION =  {peak:.3f}    CM/SEC/SEC  AT   1. SEC.",
        ]
        lines += [*["HEADER"] * 7, *block([0] * 100, "5d", 16), *block([0.0] * 100, "10.3f", 8)]
        for name, unit in (("ACCEL", "CM/SEC/SEC"), ("VELOC", "CM/SEC"), ("DISPL", "CM")):
            lines += [f" {announce.format(len(samples), name, step, unit)}", *block(samples, "10.3f", 8)]
        lines += [f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------"]
    return lines


def usc(samples, step=0.02):
    lines = csmip_v2([samples], step, "{} POINTS OF {} DATA EQUALLY SPACED AT  {:.3f} SEC.  IN UNITS {}")[:-1]
    return [line.replace("OF ACCEL DATA", "OF ACC DATA") for line in lines]


def cosmos(channels, step=0.005, title="Corrected acceleration    (Format v01.20 with 13 text lines)"):
    lines = []
    for number, samples in enumerate(channels, 1):
        reals = [-999.0] * 100
        reals[33], reals[61], reals[63] = 0.02, 1000 * step, max(samples, key=abs)
        lines += [title, "Record of a", "Hypocenter:", "Origin:"]
        lines += ["Statn No: 01-23075  Code:CE-J2236  Town - Street", "Coords:", "Recorder:", "Rcrd start"]
        lines += [
            f"Sta Cha:  {number}: {90 * number} deg (Rcrdr Chan  1) Location: x",
            "Raw",
            "Processed",
            "Record",
            "Values",
        ]
        lines += [
            " 100 Integer-header values follow on  10 lines, Format= (10I8)",
            *block([-999] * 100, "8d", 10),
        ]
        lines += [" 100 Real-header values follow on  20 lines, Format= (5F15.6)", *block(reals, "15.6f", 5)]
        lines += ['   1 Comment line(s) follow, each starting with a "|":', "| comment 1 2"]
        lines += [f"   {len(samples)} acceleration pts, approx  1 secs, units=cm/sec2(04),Format=(8F10.5)"]
        lines += [*block(samples, "10.5f", 8), f"End-of-data for Chan {number} acceleration"]
    return lines


def knet(counts, rate=100, factor="3920(gal)/6182761"):
    peak = np.abs(np.subtract(counts, np.mean(counts))).max() * 3920 / 6182761
    header = {
        "Origin Time": "2011/03/11 14:46:00",
        "Lat.": "38.103",
        "Long.": "142.860",
        "Depth. (km)": "24",
        "Mag.": "9.0",
        "Station Code": "XYZ005",
        "Station Lat.": "36.1256",
        "Station Long.": "140.0901",
        "Station Height(m)": "27",
        "Record Time": "2011/03/11 14:47:21",
        "Sampling Freq(Hz)": f"{rate}Hz",
        "Duration Time(s)": "300",
        "Dir.": "N-S",
        "Scale Factor": factor,
        "Max. Acc. (gal)": f"{peak:.3f}",
        "Last Correction": "2011/03/11 14:47:06",
        "Memo.": "",
    }
    return [*(f"{key:18}{value}" for key, value in header.items()), *block(counts, "9d", 8)]


def esm(samples, step=0.005):
    header = {"EVENT_NAME": "VALLEY", "STATION_CODE": "XYZ", "STATION_NAME": "Town Hall"}
    header |= {
        "SAMPLING_INTERVAL_S": f"{step:.6f}",
        "NDATA": len(samples),
        "STREAM": "HNE",
        "UNITS": "cm/s^2",
    }
    header |= {"PGA_CM/S^2": f"{max(samples, key=abs):.6f}"} | {f"USER{k}": "" for k in range(56)}
    return [*(f"{key}: {value}" for key, value in header.items()), *(f"{value:.6f}" for value in samples)]


def geonet(channels, step=0.02, *, raw=False):
    lines = []
    for number, samples in enumerate(channels):
        title = "Uncorrected" if raw else "Corrected"
        text = [f"{title} accelerogram 20161113_XYZ GNS Science", "Site XYZ      42 37 10S", "Town Farm"]
        text += [*["header"] * 9, f"Component N{number}W  Longitudinal"]
        text += [
            f"Acceleration:  peak  {max(samples, key=abs):.1f} mm/s/s at  1 sec",
            "Velocity:",
            "Displacement:",
        ]
        numbers = [0.0] * 100
        numbers[30] = numbers[33] = numbers[34] = numbers[35] = len(samples)
        numbers[40], numbers[65] = 1 / step, step
        lines += [*text, *block(numbers, "8.3f", 10)]
        for _ in range(1 if raw else 3):
            lines += block(samples, "8.1f", 10)
    return lines


def columns(samples, step=0.01, header=("time (s), acceleration (m/s2)",)):
    return [*header, *(f"{round(k * step, 6)}, {value:.5f}" for k, value in enumerate(samples))]
