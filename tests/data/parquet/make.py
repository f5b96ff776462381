"""Makes the Parquet files beside it, by an implementation that is not ours: pip install pyarrow (26.0.1)."""

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

HERE = Path(__file__).parent
ROWS = range(300)
table = pa.table({
    "t": pa.array([1_700_000_000_000_000 + 50 * i for i in ROWS], pa.timestamp("us", tz="UTC")),
    "X1 [nm]": pa.array([37 * i % 400 * 1000 for i in ROWS], pa.int32()),
    "Y1_um": pa.array([0.5 * (i % 64) for i in ROWS], pa.float32()),
    "X2_mm": pa.array([None if i % 10 == 3 else (i % 128) / 1024 for i in ROWS], pa.float64()),
    "Y2_um": pa.array([-1.0 * i for i in ROWS], pa.float64()),
    "AMB": pa.array([i < 200 for i in ROWS]),
    "note": pa.array(["a text" for _ in ROWS]),
})
pq.write_table(table, HERE / "logger.parquet", compression="snappy", row_group_size=128)
pq.write_table(table, HERE / "pages.parquet", compression="none", data_page_version="2.0", data_page_size=256,
               use_dictionary=False, column_encoding={"t": "DELTA_BINARY_PACKED", "Y2_um": "BYTE_STREAM_SPLIT"})
pq.write_table(table, HERE / "zstd.parquet", compression="zstd")
