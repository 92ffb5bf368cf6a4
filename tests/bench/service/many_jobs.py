"""Rows of jobs that never ran, in a database that no fvd has open."""

import contextlib
import sqlite3


def copy_jobs(file, jobs, values):
    """As if the one job that is there (its row has the number 1) had been run so often. values: columns that differ, as
    SQL over i, the number of the new row; what is not named is that of the first."""
    own = {"number": "i", "job_id": "'bench-' || i", "seq": "i", "result_dir": "result_dir || '-' || i",
           "files_pending": "0",  # or fvd goes through all of them for files that it owes
           **values}
    with contextlib.closing(sqlite3.connect(file)) as database:
        database.execute("PRAGMA synchronous=OFF")
        columns = [row[1] for row in database.execute("PRAGMA table_info(jobs)")]
        if unknown := own.keys() - set(columns):
            raise ValueError(f"jobs has no columns {', '.join(sorted(unknown))}")
        chosen = ", ".join(own.get(column, column) for column in columns)
        database.execute(f"WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n WHERE i < {jobs}) "
                         f"INSERT INTO jobs ({', '.join(columns)}) SELECT {chosen} FROM n, jobs WHERE jobs.number = 1")
        database.commit()
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
