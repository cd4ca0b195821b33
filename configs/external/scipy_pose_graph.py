"""Pose-graph optimisation with scipy: chordal start, then Levenberg-Marquardt with sparse
normal equations on the twist error that loopbench's graph_cost computes."""

import numpy as np
from scipy.sparse import bsr_matrix, csc_matrix, identity
from scipy.sparse.linalg import splu
from scipy.spatial.transform import Rotation

import loopbench


def factorise(H):
    """Factors of a symmetric positive definite matrix, in a fill-reducing order."""
    return splu(
        H.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )


def skew(v):
    out = np.zeros(v.shape[:-1] + (3, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return out - np.swapaxes(out, -1, -2)


def apply(matrices, vectors):
    return np.einsum("...ij,...j->...i", matrices, vectors)


def log_se3(R, t):
    """Twists [rho; phi] of poses."""
    phi = Rotation.from_matrix(R).as_rotvec()
    angle = np.linalg.norm(phi, axis=1)
    safe = np.where(angle < 1e-4, 1.0, angle)
    factor = np.where(
        angle < 1e-4,
        1 / 12 + angle**2 / 720,
        1 / safe**2 - (1 + np.cos(safe)) / (2 * safe * np.sin(safe) + (angle < 1e-4)),
    )
    W = skew(phi)
    rho = t - apply(W, t) / 2 + factor[:, None] * apply(W, apply(W, t))
    return np.hstack([rho, phi])


def inverse_right_jacobian(e):
    """Series in ad(e), to rounding for residuals below about 0.1."""
    ad = np.zeros((len(e), 6, 6))
    ad[:, :3, :3] = ad[:, 3:, 3:] = skew(e[:, 3:])
    ad[:, :3, 3:] = skew(e[:, :3])
    square = ad @ ad
    fourth = square @ square
    return np.eye(6) + ad / 2 + square / 12 - fourth / 720 + fourth @ square / 30240


class Graph:
    def __init__(self, problem):
        both = [problem.odometry, problem.closures]
        self.i = np.concatenate([e.begin for e in both])
        self.j = np.concatenate([e.end for e in both])
        measured = np.concatenate([e.poses for e in both])
        self.R = Rotation.from_quat(measured[:, 3:]).as_matrix()
        self.t = measured[:, :3]
        self.information = np.concatenate([e.information for e in both])
        self.n = len(problem.keyframes)

    def errors(self, R, t):
        Rt = np.swapaxes(R[self.i], 1, 2)
        relative = Rt @ R[self.j], apply(Rt, t[self.j] - t[self.i])
        Zt = np.swapaxes(self.R, 1, 2)
        return log_se3(Zt @ relative[0], apply(Zt, relative[1] - self.t)), relative

    def cost(self, R, t):
        e = self.errors(R, t)[0]
        return float(np.einsum("mi,mij,mj->", e, self.information, e))

    def system(self, R, t):
        """Hessian and gradient without the first keyframe, which is fixed."""
        e, (Rij, tij) = self.errors(R, t)
        J = inverse_right_jacobian(e)
        adjoint = np.zeros((len(e), 6, 6))
        back = np.swapaxes(Rij, 1, 2)
        adjoint[:, :3, :3] = adjoint[:, 3:, 3:] = back
        adjoint[:, :3, 3:] = -back @ skew(tij)
        A, B = -J @ adjoint, J
        At, Bt = np.swapaxes(A, 1, 2), np.swapaxes(B, 1, 2)
        O = self.information
        blocks = np.concatenate([At @ O @ A, At @ O @ B, Bt @ O @ A, Bt @ O @ B])
        rows = np.concatenate([self.i, self.i, self.j, self.j])
        columns = np.concatenate([self.i, self.j, self.i, self.j])
        offsets = np.arange(6)
        row = (6 * rows[:, None, None] + offsets[None, :, None]).repeat(6, 2)
        column = (6 * columns[:, None, None] + offsets[None, None, :]).repeat(6, 1)
        size = 6 * self.n
        H = csc_matrix((blocks.ravel(), (row.ravel(), column.ravel())), shape=(size, size))
        g = np.zeros((self.n, 6))
        Oe = apply(O, e)
        np.add.at(g, self.i, apply(At, Oe))
        np.add.at(g, self.j, apply(Bt, Oe))
        return H[6:, 6:], g.ravel()[6:]

    def chordal(self, R0, t0):
        """Rotations from the relaxation R_j = R_i Z, projected; then translations."""
        m = len(self.i)
        w = np.sqrt(self.information[:, [3, 4, 5], [3, 4, 5]].mean(1))
        eye = np.broadcast_to(np.eye(3), (m, 3, 3))
        blocks = np.stack([-w[:, None, None] * np.swapaxes(self.R, 1, 2), w[:, None, None] * eye], 1)
        A = self._pairs(blocks)
        solved = factorise(A[:, 3:].T @ A[:, 3:]).solve(-A[:, 3:].T @ (A[:, :3] @ R0.T))
        free = np.swapaxes(solved.reshape(-1, 3, 3), 1, 2)
        U, _, V = np.linalg.svd(free)
        U[:, :, 2] *= np.sign(np.linalg.det(U @ V))[:, None]
        R = np.concatenate([R0[None], U @ V])
        w = np.sqrt(self.information[:, [0, 1, 2], [0, 1, 2]].mean(1))
        A = self._pairs(np.stack([-w[:, None, None] * eye, w[:, None, None] * eye], 1))
        b = (w[:, None] * apply(R[self.i], self.t)).ravel() - A[:, :3] @ t0
        t = factorise(A[:, 3:].T @ A[:, 3:]).solve(A[:, 3:].T @ b)
        return R, np.concatenate([t0[None], t.reshape(-1, 3)])

    def _pairs(self, blocks):
        """Sparse matrix with a block row per edge and the blocks of its two keyframes."""
        m = len(self.i)
        indices = np.stack([self.i, self.j], 1).ravel()
        data = blocks.reshape(2 * m, 3, 3)
        return bsr_matrix((data, indices, 2 * np.arange(m + 1)), (3 * m, 3 * self.n)).tocsc()


def moved(R, t, step):
    d = step.reshape(-1, 6)
    phi = d[:, 3:]
    angle = np.linalg.norm(phi, axis=1)[:, None]
    safe = np.where(angle < 1e-6, 1.0, angle)
    W = skew(phi)
    a = np.where(angle < 1e-6, 0.5, (1 - np.cos(safe)) / safe**2)
    b = np.where(angle < 1e-6, 1 / 6, (safe - np.sin(safe)) / safe**3)
    V = d[:, :3] + a * apply(W, d[:, :3]) + b * apply(W, apply(W, d[:, :3]))
    R, t = R.copy(), t.copy()
    t[1:] += apply(R[1:], V)
    R[1:] = R[1:] @ Rotation.from_rotvec(phi).as_matrix()
    return R, t


@loopbench.corrector
def scipy_pose_graph(problem):
    if problem.similarity:
        raise loopbench.Declined("the edges change the scale")
    if not len(problem.closures):
        raise loopbench.Declined("no loop closures")
    graph = Graph(problem)
    R = Rotation.from_quat(problem.poses[:, 3:]).as_matrix()
    t = problem.poses[:, :3].copy()
    start = graph.chordal(R[0], t[0])
    cost = before = graph.cost(R, t)
    if graph.cost(*start) < cost:
        R, t = start
        cost = graph.cost(R, t)
    damping = 1e-6
    iterations = 0
    while iterations < 1000:
        iterations += 1
        H, g = graph.system(R, t)
        step = factorise(H + damping * identity(H.shape[0])).solve(-g)
        trial = moved(R, t, step)
        after = graph.cost(*trial)
        if not after < cost:
            if np.abs(step).max() < 1e-9 or damping > 1e12:
                break
            damping *= 100
            continue
        gained, cost = cost - after, after
        R, t = trial
        damping = max(damping / 10, 1e-9)
        if gained < 1e-12 * cost:
            break
    poses = np.hstack([t, Rotation.from_matrix(R).as_quat()])
    return poses, {"iterations": iterations, "counts": {"chi2_before": before, "chi2": cost}}


if __name__ == "__main__":
    loopbench.serve()
