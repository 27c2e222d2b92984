# Stage 1: the viewer.
FROM node:22-bookworm-slim AS viewer
WORKDIR /src
COPY static/package.json static/package-lock.json static/
RUN npm --prefix static ci --no-audit --no-fund
COPY static static
RUN npm --prefix static run build

# Stage 2: the wheel and its locked dependencies.
FROM python:3.11-slim-bookworm AS build
WORKDIR /src
RUN python -m venv /opt/risorius
COPY requirements.lock .
RUN /opt/risorius/bin/pip install --no-cache-dir --require-hashes -r requirements.lock
COPY pyproject.toml README.md LICENSE ./
COPY engine engine
COPY service service
COPY static/build_hook.py static/build_hook.py
COPY --from=viewer /src/service/viewer service/viewer
RUN RISORIUS_SKIP_VIEWER=1 /opt/risorius/bin/pip install --no-cache-dir --no-deps --no-build-isolation .

# Stage 3: what runs. The kernels are compiled for a named processor, so that an image built on one
# machine starts warm on another.
# Other machines reach it, so it asks for a key: the first start makes one, prints it this once (see
# `docker logs`) and keeps its hash in /data; `risorius keys` in the container makes others.
FROM python:3.11-slim-bookworm
ENV PATH=/opt/risorius/bin:$PATH \
    NUMBA_CPU_NAME=x86-64-v3 \
    NUMBA_CPU_FEATURES=+avx2,+fma \
    NUMBA_CACHE_DIR=/cache/numba \
    RISORIUS_CACHE_DIR=/cache/risorius \
    RISORIUS_DATA_DIR=/data \
    RISORIUS_HOST=0.0.0.0 \
    RISORIUS_MAKE_KEY=1 \
    OPENBLAS_NUM_THREADS=1
COPY --from=build /opt/risorius /opt/risorius
RUN mkdir -p /cache /data && chown nobody:nogroup /cache /data
USER nobody
RUN risorius warm
VOLUME ["/cache", "/data"]
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=3s --start-period=60s \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8000/api/ready')"]
CMD ["risorius", "serve"]
