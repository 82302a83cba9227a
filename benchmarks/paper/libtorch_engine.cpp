// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <fmt/core.h>
#include <torch/torch.h>

#include <map>

#include "adaptive_rate.hpp"
#include "dermis/learn/calibration/parallel.hpp"
#include "engine.hpp"
#include "forms.hpp"

namespace dermis::benchmarks {
namespace {

using torch::Tensor;

/// A tensor of its own with these values.
Tensor tensor(std::span<const float> values, torch::IntArrayRef sizes) {
  return torch::tensor(torch::ArrayRef<float>(values.data(), values.size())).view(sizes);
}

std::span<const float> values(const Tensor& tensor) {
  return {tensor.data_ptr<float>(), static_cast<std::size_t>(tensor.numel())};
}

std::int64_t size(std::size_t count) {
  return static_cast<std::int64_t>(count);
}

/// The network 2-H-1 by autograd, with its parameters and gradients each in one tensor, of which the layers are views:
/// the rules of traingdx are then four operations on all parameters at once.
class PeaksTraining {
 public:
  explicit PeaksTraining(const PeaksProblem& problem)
      : inputs_(tensor(problem.inputs, {-1, 2})),
        targets_(tensor(problem.targets, {-1, 1})),
        start_(tensor(problem.parameters, {-1})),
        parameters_(start_.clone()),
        gradient_(torch::zeros_like(start_)) {
    const std::int64_t hidden = size(problem.shape.layers[0].units);
    add_layer(0, hidden, 2);
    add_layer(3 * hidden, 1, hidden);
    start_error_ = error_and_gradient();
    start_gradient_ = gradient_.clone();
  }

  void run(std::size_t epochs) {
    const torch::NoGradGuard no_gradient;
    parameters_.copy_(start_);
    kept_ = start_.clone();
    kept_gradient_ = start_gradient_.clone();
    error_ = start_error_;
    rate_ = Rules::kFirstRate;
    step_ = kept_gradient_ * -rate_;
    for (std::size_t epoch = 0; epoch < epochs; ++epoch) run_epoch();
  }

  [[nodiscard]] const Tensor& parameters() const { return kept_; }

 private:
  using Rules = AdaptiveRateDescent<float>;

  void add_layer(std::int64_t first, std::int64_t units, std::int64_t fan_in) {
    const auto add = [&](std::int64_t from, torch::IntArrayRef sizes, std::int64_t count) {
      Tensor leaf = parameters_.narrow(0, from, count).view(sizes).detach().requires_grad_();
      leaf.mutable_grad() = gradient_.narrow(0, from, count).view(sizes);
      leaves_.push_back(leaf);
    };
    add(first, {units, fan_in}, units * fan_in);
    add(first + units * fan_in, {units}, units);
  }

  double error_and_gradient() {
    const torch::AutoGradMode with_gradient(true);
    gradient_.zero_();
    const Tensor hidden = torch::sigmoid(torch::addmm(leaves_[1], inputs_, leaves_[0].t()));
    const Tensor error = torch::mse_loss(torch::addmm(leaves_[3], hidden, leaves_[2].t()), targets_);
    error.backward();
    return error.item<double>();
  }

  void run_epoch() {
    torch::add_out(parameters_, kept_, step_);
    const double trial_error = error_and_gradient();
    if (trial_error > Rules::kMaxErrorIncrease * error_) {
      rate_ *= Rules::kRateDecrease;
      torch::mul_out(step_, kept_gradient_, torch::scalar_tensor(-rate_));
      return;
    }
    if (trial_error < error_) rate_ *= Rules::kRateIncrease;
    error_ = trial_error;
    kept_.copy_(parameters_);
    kept_gradient_.copy_(gradient_);
    step_.mul_(Rules::kMomentum).add_(gradient_, -rate_ * (1.0 - Rules::kMomentum));
  }

  Tensor inputs_;
  Tensor targets_;
  Tensor start_;
  Tensor start_gradient_;
  Tensor parameters_;  ///< Where the error is taken.
  Tensor gradient_;
  Tensor kept_;  ///< The best point so far.
  Tensor kept_gradient_;
  Tensor step_;
  std::vector<Tensor> leaves_;
  double start_error_ = 0.0;
  double error_ = 0.0;
  double rate_ = 0.0;
};

/// The parameters of all networks, one tensor a layer, as the gemm of each form likes them.
struct BankLayer {
  Tensor weights;     ///< [networks, units, fan_in]
  Tensor thresholds;  ///< [networks, units]
};

std::vector<BankLayer> bank_layers(const BankProblem& problem) {
  const std::int64_t networks = size(problem.networks);
  const Tensor all = torch::from_blob(const_cast<float*>(problem.all_parameters.data()),  // NOLINT: only read
                                      {networks, size(problem.shape.parameter_count())});
  std::vector<BankLayer> layers;
  for (std::size_t layer = 0; layer < problem.shape.layers.size(); ++layer) {
    const std::int64_t units = size(problem.shape.layers[layer].units);
    const std::int64_t fan_in = size(problem.shape.fan_in(layer));
    const auto part = [&](std::size_t first, std::int64_t count) { return all.narrow(1, size(first), count); };
    layers.push_back({part(problem.shape.weights(layer), units * fan_in).reshape({networks, units, fan_in}).clone(),
                      part(problem.shape.thresholds(layer), units).clone()});
  }
  return layers;
}

/// Those of the networks first ... first + count - 1, in the same memory.
std::vector<BankLayer> part_of(const std::vector<BankLayer>& layers, std::int64_t first, std::int64_t count) {
  std::vector<BankLayer> part;
  for (const BankLayer& layer : layers) {
    part.push_back({layer.weights.narrow(0, first, count), layer.thresholds.narrow(0, first, count)});
  }
  return part;
}

// Three ways to write the inference of a bank: frames [count, inputs] -> outputs [networks, count, 1].

Tensor samples_in_rows(const std::vector<BankLayer>& layers, const Tensor& frames) {
  Tensor value = frames.unsqueeze(0).expand({layers[0].weights.size(0), -1, -1});
  for (const BankLayer& layer : layers) {
    value = torch::baddbmm(layer.thresholds.unsqueeze(1), value, layer.weights.transpose(1, 2)).sigmoid_();
  }
  return value;
}

Tensor samples_in_columns(const std::vector<BankLayer>& layers, const Tensor& frames) {
  Tensor value = frames.t().unsqueeze(0).expand({layers[0].weights.size(0), -1, -1});
  for (const BankLayer& layer : layers) {
    value = torch::baddbmm(layer.thresholds.unsqueeze(2), layer.weights, value).sigmoid_();
  }
  return value.transpose(1, 2);
}

/// All networks see the same frames: their first layers are one product.
Tensor one_first_layer(const std::vector<BankLayer>& layers, const Tensor& frames) {
  const Tensor weights = layers[0].weights.reshape({-1, frames.size(1)});
  const Tensor thresholds = layers[0].thresholds.reshape(-1);
  Tensor value = frames.size(0) == 1 ? torch::addmv(thresholds, weights, frames[0])
                                     : torch::addmm(thresholds.unsqueeze(1), weights, frames.t());
  value = value.sigmoid_().view({layers[0].weights.size(0), -1, frames.size(0)});
  for (std::size_t layer = 1; layer < layers.size(); ++layer) {
    value = torch::baddbmm(layers[layer].thresholds.unsqueeze(2), layers[layer].weights, value).sigmoid_();
  }
  return value.transpose(1, 2);
}

using Inference = Tensor (*)(const std::vector<BankLayer>& layers, const Tensor& frames);
constexpr std::pair<const char*, Inference> kInferences[] = {
    {"baddbmm, samples in rows", samples_in_rows},
    {"baddbmm, samples in columns", samples_in_columns},
    {"first layers in one product, then baddbmm", one_first_layer},
};

/// OpenBLAS does libtorch's matrix products, with threads of its own.
void use_blas_threads(int threads) {
  using SetThreads = void (*)(int);
  static const auto set_threads = reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(threads);
}

/// How libtorch can use the threads: its own and those of OpenBLAS; only its own; or neither, with the networks shared
/// out among threads of ours. body(first, count) works on so many networks from the first.
template <typename Body>
std::vector<Form> threaded(const std::string& name, std::int64_t networks, int threads, Body body) {
  const auto all = [=](int blas_threads) {
    return [=] {
      use_blas_threads(blas_threads);
      body(0, networks);
    };
  };
  if (threads == 1) return {{name, all(1)}};
  const auto shared_out = [=] {
    use_blas_threads(1);
    const std::int64_t count = (networks + threads - 1) / threads;
    learn::calibration::parallel_for(static_cast<std::size_t>(threads), [&](std::size_t part) {
      at::set_num_threads(1);  // of this thread
      const std::int64_t first = std::min(networks, size(part) * count);
      body(first, std::min(count, networks - first));
    });
    at::set_num_threads(threads);
  };
  return {{name + "; threads of OpenBLAS and of libtorch", all(threads)},
          {name + "; threads of libtorch only", all(1)},
          {name + "; networks shared out to threads", shared_out}};
}

/// The training of some networks of the bank by autograd: each network gathers its own batch, as ours does.
class BankTraining {
 public:
  BankTraining(const BankProblem& problem, Rule rule, std::int64_t first, std::int64_t count)
      : networks_(count),
        batch_(size(problem.batch)),
        database_(tensor(problem.database, {-1, size(problem.size())})),
        targets_(tensor(problem.targets, {-1, size(problem.networks)}).narrow(1, first, count).contiguous()) {
    const std::vector<std::int64_t> chosen(problem.chosen.begin() + first * batch_,
                                           problem.chosen.begin() + (first + count) * batch_);
    chosen_ = torch::tensor(chosen);
    own_column_ = torch::arange(count).repeat_interleave(batch_);
    for (const BankLayer& layer : part_of(bank_layers(problem), first, count)) {
      leaves_.push_back(layer.weights.clone().requires_grad_());
      leaves_.push_back(layer.thresholds.clone().requires_grad_());
    }
    if (rule == Rule::adam) {
      optimizer_ = std::make_unique<torch::optim::Adam>(leaves_, torch::optim::AdamOptions(kAdamRate));
    } else {
      optimizer_ = std::make_unique<torch::optim::SGD>(leaves_, torch::optim::SGDOptions(kDescentRate));
    }
  }

  void step(bool keep_gradients) {
    if (keep_gradients) {
      optimizer_->zero_grad();
    } else {
      for (const Tensor& leaf : leaves_) leaf.mutable_grad().reset();
    }
    Tensor value = database_.index_select(0, chosen_).view({networks_, batch_, -1});
    for (std::size_t layer = 0; layer < leaves_.size(); layer += 2) {
      value = torch::baddbmm(leaves_[layer + 1].unsqueeze(1), value, leaves_[layer].transpose(1, 2)).sigmoid();
    }
    const Tensor targets = targets_.index({chosen_, own_column_}).view({networks_, batch_, 1});
    const Tensor error = (value - targets).square().sum() * (0.5 / static_cast<double>(batch_));
    error.backward();
    optimizer_->step();
  }

  /// Of the network that is so many behind the first.
  [[nodiscard]] std::vector<float> parameters(std::int64_t network) const {
    std::vector<float> all;
    for (const Tensor& leaf : leaves_) {
      const Tensor own = leaf.detach()[network].contiguous();
      all.insert(all.end(), values(own).begin(), values(own).end());
    }
    return all;
  }

 private:
  std::int64_t networks_;
  std::int64_t batch_;
  Tensor database_;
  Tensor targets_;
  Tensor chosen_;
  Tensor own_column_;
  std::vector<Tensor> leaves_;  ///< Weights and thresholds of each layer.
  std::unique_ptr<torch::optim::Optimizer> optimizer_;
};

class Libtorch final : public Engine {
 public:
  [[nodiscard]] std::string name() const override { return "libtorch"; }
  [[nodiscard]] std::string version() const override {
    return fmt::format("libtorch {} ({}, not MKL; OpenMP)", TORCH_VERSION, at::hasMKL() ? "MKL" : "Debian's: OpenBLAS");
  }

  void use_threads(int threads) override {
    threads_ = threads;
    at::set_num_threads(threads);
    use_blas_threads(threads);
  }

  std::optional<Run> peaks_epoch(const PeaksProblem& problem) override {
    const auto training = std::make_shared<PeaksTraining>(problem);
    training->run(kCheckedEpochs);
    return Run{[training, epochs = problem.epochs] { training->run(epochs); },
               check_epochs(problem, values(training->parameters())), "autograd, traingdx rules"};
  }

  std::optional<Run> taxel_mlp(const TaxelProblem& problem) override {
    const c10::InferenceMode inference;
    const Tensor inputs = tensor(problem.inputs, {-1, 8});
    std::vector<Tensor> weights;
    std::vector<Tensor> thresholds;
    for (std::size_t layer = 0; layer < problem.shape.layers.size(); ++layer) {
      const std::int64_t units = size(problem.shape.layers[layer].units);
      const std::int64_t fan_in = size(problem.shape.fan_in(layer));
      const std::span<const float> all = problem.parameters;
      weights.push_back(
          tensor(all.subspan(problem.shape.weights(layer), static_cast<std::size_t>(units * fan_in)), {units, fan_in})
              .t());
      thresholds.push_back(
          tensor(all.subspan(problem.shape.thresholds(layer), static_cast<std::size_t>(units)), {units}));
    }
    const auto evaluate = [=] {
      const c10::InferenceMode guard;
      Tensor value = torch::addmm(thresholds[0], inputs, weights[0]).tanh_();
      value = torch::addmm(thresholds[1], value, weights[1]).tanh_();
      return torch::addmm(thresholds[2], value, weights[2]);
    };
    const Tensor outputs = evaluate();
    return Run{[evaluate] { evaluate(); }, check_outputs(problem, values(outputs)), "addmm, tanh_, InferenceMode"};
  }

  std::optional<Run> bank_frame(const BankProblem& problem) override { return infer(problem, 1); }
  std::optional<Run> bank_batch(const BankProblem& problem) override { return infer(problem, problem.batch); }

  std::optional<Run> bank_training(const BankProblem& problem, Rule rule) override {
    // Trainings by the networks with which they begin; one of all networks and, with threads, one a part.
    using Trainings = std::map<std::pair<std::int64_t, std::int64_t>, std::unique_ptr<BankTraining>>;
    const auto trainings = std::make_shared<Trainings>();
    const auto train = [trainings](bool keep_gradients) {
      return [=](std::int64_t first, std::int64_t count) { trainings->at({first, count})->step(keep_gradients); };
    };
    const std::int64_t networks = size(problem.networks);
    const std::int64_t part = (networks + threads_ - 1) / threads_;
    const auto add = [&](std::int64_t first, std::int64_t count) {
      trainings->emplace(std::pair(first, count), std::make_unique<BankTraining>(problem, rule, first, count));
    };
    add(0, networks);
    if (threads_ > 1) {
      for (std::int64_t first = 0; first < networks; first += part) add(first, std::min(part, networks - first));
    }
    const BankTraining& whole = *trainings->at({0, networks});
    train(true)(0, networks);
    const Check check =
        check_training_step(problem, rule, [&](std::size_t network) { return whole.parameters(size(network)); });
    std::vector<Form> forms = threaded("autograd, gradients zeroed", networks, threads_, train(true));
    for (Form& form : threaded("autograd, gradients dropped", networks, threads_, train(false))) {
      forms.push_back(std::move(form));
    }
    const Form form = fastest(forms);
    return Run{form.body, check, form.name};
  }

 private:
  std::optional<Run> infer(const BankProblem& problem, std::size_t count) const {
    const c10::InferenceMode inference;
    const std::vector<BankLayer> layers = bank_layers(problem);
    const std::int64_t networks = size(problem.networks);
    const Tensor frames = tensor(std::span(problem.frames).first(count * problem.size()), {size(count), -1});
    const Tensor outputs = torch::empty({size(count), networks});
    std::vector<Form> forms;
    for (const auto& [name, evaluate] : kInferences) {
      const auto body = [=, evaluate = evaluate](std::int64_t first, std::int64_t part) {
        const c10::InferenceMode guard;
        outputs.narrow(1, first, part).copy_(evaluate(part_of(layers, first, part), frames).squeeze(2).t());
      };
      for (Form& form : threaded(name, networks, threads_, body)) forms.push_back(std::move(form));
    }
    const Form form = fastest(forms);
    form.body();
    return Run{form.body, check_outputs(problem, count, values(outputs)), form.name};
  }

  int threads_ = 1;
};

}  // namespace

std::unique_ptr<Engine> libtorch_engine() {
  return std::make_unique<Libtorch>();
}

}  // namespace dermis::benchmarks
