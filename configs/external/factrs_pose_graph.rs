//! Optimises the pose graph of a g2o file with factrs 0.3: factrs_pose_graph gn|lm GRAPH RESULT
//! Prints the seconds of the optimisation. The example of factrs writes no poses, therefore this
//! program: the main file of a Cargo package that depends on factrs.

use std::{env, error::Error, fmt::Write, fs, time::Instant};

use factrs::{
    containers::{DefaultSymbolHandler, Values},
    core::{GaussNewton, LevenMarquardt, SE2, SE3},
    optimizers::{BaseOptParams, LevenParams, OptError},
    traits::Optimizer,
    utils::load_g20,
};

fn vertices(values: &Values) -> String {
    let mut out = String::new();
    for (key, value) in values.iter() {
        let (_, id) = DefaultSymbolHandler::key_to_sym(*key);
        if let Some(pose) = value.downcast_ref::<SE2>() {
            let (x, y, theta) = (pose.x(), pose.y(), pose.theta());
            writeln!(out, "VERTEX_SE2 {id} {x:e} {y:e} {theta:e}").expect("a string");
        } else if let Some(pose) = value.downcast_ref::<SE3>() {
            let (t, q) = (pose.xyz(), pose.rot());
            let (x, y, z) = (t[0], t[1], t[2]);
            let (qx, qy, qz, qw) = (q.x(), q.y(), q.z(), q.w());
            writeln!(
                out,
                "VERTEX_SE3:QUAT {id} {x:e} {y:e} {z:e} {qx:e} {qy:e} {qz:e} {qw:e}"
            )
            .expect("a string");
        }
    }
    out
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = env::args().collect();
    let [_, method, file, result] = args.as_slice() else {
        return Err("usage: factrs_pose_graph gn|lm GRAPH RESULT".into());
    };
    let base = BaseOptParams {
        error_tol_relative: 1e-6,
        error_tol_absolute: 0.0,
        ..Default::default()
    };
    let (graph, start) = load_g20(file);
    let begin = Instant::now();
    let mut optimizer: Box<dyn Optimizer> = match method.as_str() {
        "gn" => Box::new(GaussNewton::new(base, graph)),
        "lm" => Box::new(LevenMarquardt::new(
            LevenParams {
                base,
                ..Default::default()
            },
            graph,
        )),
        _ => return Err(format!("unknown method {method}, expected gn or lm").into()),
    };
    let poses = match optimizer.optimize(start) {
        Ok(values) | Err(OptError::MaxIterations(values)) => values,
        Err(error) => return Err(format!("factrs: {error:?}").into()),
    };
    println!("seconds {}", begin.elapsed().as_secs_f64());
    fs::write(result, vertices(&poses))?;
    Ok(())
}
